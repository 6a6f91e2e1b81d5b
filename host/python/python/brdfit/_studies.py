"""What is asked of a scan beyond its fit: profiles, comparisons, joint fits, pages, exports."""

from __future__ import annotations

import json
import os
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal, overload

import numpy as np
from numpy.typing import NDArray

from . import _brdfit, _options
from ._arrays import in_unit, numbers
from ._brdfit import Scan
from ._command import exported, run, write
from ._fit import proof, told
from ._needed import needed
from .results import Fit

if TYPE_CHECKING:
    import pandas as pd
    from typing_extensions import Unpack


def _subject(of: Scan | Fit, search: _options.Search) -> tuple[Scan, dict[str, Any]]:
    if isinstance(of, Fit):
        return of.scan, {**of.options, **search}
    if isinstance(of, Scan):
        return of, {**search}
    raise TypeError(f"this takes a Scan or a Fit, not {type(of).__name__}; brdfit.scan makes one of arrays")


def _number(found: float | None) -> float:
    return float("nan") if found is None else found


@dataclass(frozen=True)
class Interval:
    """The values of a parameter that a scan does not refute at a level."""

    level: float
    """Confidence, 0 to 1."""
    low: float
    """Least value; NaN where the fit is exact, as nothing tells an interval then."""
    high: float
    """Largest value; NaN likewise."""
    low_at_bound: bool
    """The least value is the bound of the parameter: the data do not end the interval."""
    high_at_bound: bool
    """The same of the largest."""


@dataclass(frozen=True, eq=False)
class Profile:
    """The cost over one parameter, minimised over the others."""

    name: str
    """The parameter."""
    best: float
    """Where the cost is least."""
    stderr: float
    """Its standard error; NaN where it is on a bound or not seen, or the fit is exact."""
    intervals: tuple[Interval, ...]
    """At 68 % and 95 %."""
    value: NDArray[np.float64]
    """Where the parameter was held; shape (points,)."""
    cost: NDArray[np.float64]
    """The least sum of squared residuals there; shape (points,)."""
    rise: NDArray[np.float64]
    """Its rise above the least of all, over the variance of a residual; shape (points,)."""
    x: NDArray[np.float64]
    """All parameters there; shape (points, parameters)."""


@dataclass(frozen=True, eq=False)
class Profiles:
    """Profiles of several parameters."""

    parameters: dict[str, Profile]
    """By name."""
    cost: float
    """Sum of squared residuals of the best fit."""
    improved_from: float | None
    """That of the search, if a profile met a better fit."""
    bootstrap: dict[str, tuple[float, tuple[Interval, ...]]] | None
    """Of each parameter the median and intervals over copies of the scan with new noise, if asked for."""
    details: dict[str, Any]
    """The object that `brdfit profile --format json` writes."""

    def __getitem__(self, name: str) -> Profile:
        return self.parameters[name]


def profile(
    of: Scan | Fit,
    parameters: str | Iterable[str] = (),
    *,
    bootstrap: int | None = None,
    calibrate: int | None = None,
    **search: Unpack[_options.Search],
) -> Profiles:
    """Which values of its parameters a scan allows: the profile likelihood.

    Parameters
    ----------
    of : a scan; or a fit, whose scan and keywords are used.
    parameters : names; by default all that are not fixed.
    bootstrap : number of copies of the fitted scan with new noise, 20 or more, whose fits give percentiles too.
    calibrate : number of copies at each end of an interval that give its threshold, in place of the F test's.
    search : as for `fit`.

    Raises
    ------
    ValueError : an argument is not valid, or the scan cannot be fitted.
    """
    scan, options = _subject(of, search)
    own = {"parameter": parameters or None, "bootstrap": bootstrap, "calibrate": calibrate}
    words = ["--format=json", *_options.words(own, own, "profile"), *_options.search(options, "profile")]
    details = json.loads(run("profile", words, scan.table()))

    def one(found: dict[str, Any]) -> Profile:
        points = found["points"]
        column = {name: np.array([point[name] for point in points]) for name in ("value", "cost", "rise")}
        x = np.array([point["parameters"] for point in points])
        stderr = _number(found["stderr"])
        ends = ("low", "high")
        intervals = tuple(Interval(**{**one, **{end: _number(one[end]) for end in ends}}) for one in found["intervals"])
        return Profile(found["name"], found["best"], stderr, intervals, x=x, **column)

    copies = details["bootstrap"]
    levels = [interval["level"] for interval in details["parameters"][0]["intervals"]]
    return Profiles(
        parameters={found["name"]: one(found) for found in details["parameters"]},
        cost=details["cost"],
        improved_from=details["improved_from"],
        bootstrap=copies
        and {
            found["name"]: (
                found["median"],
                tuple(Interval(level, low, high, False, False) for level, (low, high) in zip(levels, found["intervals"])),
            )
            for found in copies["parameters"]
        },
        details=details,
    )


@dataclass(frozen=True, eq=False)
class Comparison:
    """Several models, fitted to the same scan."""

    model: str
    """That of least BIC."""
    models: list[dict[str, Any]]
    """Of each model its name, parameters, mse2, rms_ln, aicc, bic and minima."""

    def to_pandas(self) -> pd.DataFrame:
        """One row a model, as a pandas.DataFrame, best first."""
        rows = [{**one, **one["parameters"]} for one in self.models]
        frame = needed("pandas", "to_pandas()").DataFrame(rows)
        best_first: pd.DataFrame = frame.drop(columns="parameters").set_index("model").sort_values("bic")
        return best_first


def compare(of: Scan | Fit, models: str | Iterable[str] = "auto", *, seed: int = 0) -> Comparison:
    """Which model a scan needs: each is fitted, and judged by AICc and BIC.

    Parameters
    ----------
    of : a scan; or a fit, whose scan is used.
    models : names of `MODELS`, or "auto" for all.
    seed : of the searches.

    Raises
    ------
    ValueError : there is no such model, or the scan cannot be fitted.
    """
    scan, _ = _subject(of, {})
    own = {"models": models, "seed": seed}
    details = json.loads(run("compare", ["--format=json", *_options.words(own, own, "compare")], scan.table()))
    return Comparison(details["model"], details["models"])


@dataclass(frozen=True, eq=False)
class Joint:
    """Several scans, fitted together."""

    model: str
    """The model."""
    shared: tuple[str, ...]
    """The parameters that are the same in all scans."""
    parameters: tuple[dict[str, float], ...]
    """Of each scan, by name."""
    stderr: tuple[dict[str, float | None], ...]
    """Their standard errors; None on a bound, or of what is not determined, as `undetermined` of `details` and its scans has it."""
    cost: float
    """Sum of squared residuals of ln BRDF over all scans."""
    cost_separate: float
    """The same of fits of each scan on its own."""
    details: dict[str, Any]
    """The object that `brdfit joint --format json` writes."""


@dataclass(frozen=True, eq=False)
class Repeats:
    """The budget of uncertainty over runs of one sample."""

    model: str
    """The model that was fitted to each."""
    quantities: list[dict[str, Any]]
    """Of each parameter and derived quantity its name, unit, values and standard errors of the runs, runs_that_disagree (from 1), and budget: mean, between, within, type_a, type_b, combined, coverage_factor, expanded, ...; None if a run does not tell it."""
    details: dict[str, Any]
    """The object that `brdfit joint --repeats --format json` writes."""

    def to_pandas(self) -> pd.DataFrame:
        """One row a quantity, with its budget, as a pandas.DataFrame."""
        rows = [{**one, **(one["budget"] or {})} for one in self.quantities]
        frame: pd.DataFrame = needed("pandas", "to_pandas()").DataFrame(rows).drop(columns="budget")
        return frame


@overload
def joint(
    scans: Sequence[Scan | Fit],
    share: str | Iterable[str] | None = None,
    *,
    repeats: Literal[False] = False,
    **search: Unpack[_options.Search],
) -> Joint: ...
@overload
def joint(
    scans: Sequence[Scan | Fit],
    share: str | Iterable[str] | None = None,
    *,
    repeats: Literal[True],
    **search: Unpack[_options.Search],
) -> Repeats: ...
def joint(
    scans: Sequence[Scan | Fit],
    share: str | Iterable[str] | None = None,
    *,
    repeats: bool = False,
    **search: Unpack[_options.Search],
) -> Joint | Repeats:
    """Fits two to eight scans of one material together, such as wavelengths that share m; or compares runs of one sample.

    Parameters
    ----------
    scans : the scans, or fits of them.
    share : names of the parameters that are the same in all scans; "m" by default.
    repeats : the scans, two or more, are runs of one sample: each is fitted alone, and the budget of uncertainty over them is made.
    search : as for `fit`.

    Raises
    ------
    ValueError : an argument is not valid, or the scans cannot be fitted.
    """
    if isinstance(scans, (Scan, Fit)):
        raise TypeError("joint() takes several scans, or fits, in a list")
    own = {"share": share, "repeats": repeats}
    words = ["--format=json", *_options.words(own, own, "joint"), *_options.search(search, "joint")]
    all_of_them = _brdfit.table([_subject(one, {})[0] for one in scans])
    details = json.loads(run("joint", words, all_of_them))
    if repeats:
        return Repeats(details["model"], details["quantities"], details)
    order = [name for name, *_ in _brdfit.names(details["model"])]
    return Joint(
        model=details["model"],
        shared=tuple(details["shared"]),
        parameters=tuple({name: one["parameters"][name] for name in order} for one in details["scans"]),
        stderr=tuple({name: one["stderr"][name] for name in order} for one in details["scans"]),
        cost=details["cost"],
        cost_separate=details["cost_separate"],
        details=details,
    )


def report(
    of: Scan | Fit | Sequence[Scan | Fit],
    path: str | os.PathLike[str] | None = None,
    *,
    certify: float | None = None,
    proof_boxes: int | None = None,
    proof_seconds: float | None = None,
    **search: Unpack[_options.Search],
) -> str:
    """The page of `brdfit report` on scans: one HTML text that needs no other file, with figures and tables.

    Parameters
    ----------
    of : one or several scans; or fits, of which the first gives the keywords.
    path : where it is written too, if given.
    certify, proof_boxes, proof_seconds : as for `fit`, of each scan.
    search : as for `fit`.

    Raises
    ------
    ValueError : an argument is not valid, or a scan cannot be fitted.
    """
    every = [of] if isinstance(of, (Scan, Fit)) else list(of)
    if not every:
        raise ValueError("there is no scan to report")
    _, options = _subject(every[0], search)
    words = _options.search(options, "report")
    claim = proof(certify, proof_boxes, proof_seconds)
    shown = ", ".join(f"{name}={value!r}" for name, value in options.items())
    with told():
        page = _brdfit.report([_subject(one, {})[0] for one in every], words, claim, f"brdfit.report({shown})")
    write(page, path)
    return page


@overload
def export(
    fit: Fit | Sequence[Fit], to: Literal["rgl"], path: str | os.PathLike[str] | None = None, **options: Any
) -> bytes: ...
@overload
def export(fit: Fit | Sequence[Fit], to: str, path: str | os.PathLike[str] | None = None, **options: Any) -> str: ...
def export(
    fit: Fit | Sequence[Fit], to: str, path: str | os.PathLike[str] | None = None, **options: Any
) -> str | bytes:
    """The model for another program, as `brdfit export --to` writes it: text, or bytes in the form `rgl`.

    Parameters
    ----------
    fit : the fit; or several of one material: red, green and blue, or for rgl those at several wavelengths, which the names of their scans say, such as "550 nm", or `wavelength`.
    to : zemax, zemax-abg, fred, glsl, mitsuba, mitsuba-native, c, rust, bird, openmaterial, ...
    path : where it is written too, if given.
    options : others of `brdfit export --help`, such as name, or wavelength in nm: one, or one for each fit.

    Raises
    ------
    ValueError : the form does not exist, or cannot hold the model.
    """
    fits = [fit] if isinstance(fit, Fit) else list(fit)
    if not fits or not all(isinstance(one, Fit) for one in fits):
        raise TypeError("export() takes a Fit, or several in a list")
    texts = [one.json for one in fits]
    lengths = in_unit("wavelength", options.get("wavelength"), "nanometer")
    if np.ndim(lengths) == 1:
        if len(lengths) != len(fits):
            raise ValueError(f"wavelength has {len(lengths)} numbers for {len(fits)} fits; give one for each")
        # A form of several wavelengths finds them in the names of the scans.
        named = zip(fits, numbers("wavelength", lengths).tolist())
        texts = [json.dumps({**one.details, "scan": f"{length!r} nm"}) for one, length in named]
        del options["wavelength"]
    return exported(texts[0] if len(texts) == 1 else f"[{','.join(texts)}]", to, path, **options)
