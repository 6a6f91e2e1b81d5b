"""Keyword arguments as the words of the program's command line, so that both mean the same."""

from __future__ import annotations

import operator
import os
import re
from collections.abc import Iterable, Mapping
from typing import Any, Literal, TypedDict

import numpy as np

from ._arrays import DEGREES, in_unit

Bounds = Mapping[str, "float | tuple[float, float]"]


class Search(TypedDict, total=False):
    """How to search: the keywords of everything that fits. Each is an option of `brdfit fit --help`."""

    model: str | Iterable[str]
    """A name of `MODELS`, "beckmann" by default; of several, or of all with "auto", that of least BIC."""
    terms: str | Iterable[str]
    """"all" by default, some of "diffuse", "surface", "volume", "absorbing" (kappa is free), or "auto": the fewest that the scan supports."""
    bounds: Bounds | None
    """Of parameters by name, `(least, largest)` or the number at which it is fixed, in the parameter's unit; the others have those of their model."""
    robust: bool
    """Leaves out samples far from the fit, 6 robust standard deviations of ln BRDF."""
    prior: Mapping[str, str | tuple[float, float]]
    """What parameters are known to be from elsewhere, value and standard error: {"n": (1.5, 0.02)}, or {"n": "1.50+-0.02"} as the program has it."""
    fit_offset: bool
    """Fits the offset of the zero of theta_s too, up to 10 degrees; for scans in the plane of incidence."""
    aperture_half_angle: float
    """Half-angle of the cone that the detector sees from the sample, degrees: the model is averaged over it."""
    scale_uncertainty: float
    """Relative standard uncertainty of the calibration, which adds to errors and changes no value."""
    conserve_energy: bool
    """Holds the reflectance to at most 1 at the angles of incidence of the scan."""
    method: Literal["default", "paper"]
    """"default", or "paper" for fits from 250 uniform starts, which list more minima."""
    starts: int
    """Number of starts, 1 to 1 000 000."""
    seed: int
    """Of the search, 0 to 2^64 - 1; the same seed gives the same bits."""
    precision: Literal["f64", "f32"]
    """Number type of the computation."""
    threads: int | None
    """Number of threads, 1 to 1024, which changes no bit; by default one for each core."""


class Reading(TypedDict, total=False):
    """How files are read: what the program's `brdfit inspect --help` lists under the same names."""

    input_format: str
    sheet: str | Iterable[str]
    column: str | Iterable[str]
    quantity: str
    angles: Literal["deg", "rad"]
    forward: Literal["positive", "negative"]
    value_unit: str
    wavelength_unit: str
    polarisation: Literal["apart", "mean"]
    columns: Mapping[str, "str | int"]
    split: str | Iterable[str]
    ignore: str | Iterable[str]
    repeats: bool
    theta_i: float | Iterable[float]
    one_scan: bool
    merl_whole: bool
    drop_invalid: bool
    mask_retro: float
    max_angle: float
    max_value: float
    thin: int
    coverage: float
    weights: Literal["file", "equal"]
    sigma_floor: float
    absolute_sigma: bool
    correct_ln_bias: bool
    weight_angle: Mapping[float, float]


# Least and largest of whole numbers.
_WHOLE = {"seed": (0, 2**64 - 1), "threads": (1, 1024), "starts": (1, 1_000_000)}
_FLAGS = {"robust", "fit_offset", "conserve_energy", "repeats", "one_scan", "merl_whole", "drop_invalid", "absolute_sigma", "correct_ln_bias"}
# What quantities of pint and astropy are taken in; others must be plain numbers.
_UNITS = dict.fromkeys(("aperture_half_angle", "mask_retro", "max_angle", "theta_i"), DEGREES) | {"wavelength": "nanometer"}
# One word for each entry, in place of one for all.
_REPEATED = {"weight_angle"}


def words(options: Mapping[str, Any], known: Iterable[str], caller: str) -> list[str]:
    """Words such as `--seed=7`."""
    names = list(known)
    found: list[str] = []
    for name, value in options.items():
        if name not in names:
            raise TypeError(f"{caller}() has no option {name!r}; its options are {', '.join(names)}")
        value = in_unit(name, value, _UNITS.get(name))
        if name in _WHOLE and value is not None:
            whole(name, value, *_WHOLE[name])
        if name in _FLAGS and value is not None:
            value = flag(name, value)
        option = "--" + name.replace("_", "-")
        if value is None or value is False:
            continue
        if value is True:
            found.append(option)
        elif name == "bounds":
            found += _bounds(value)
        elif name == "prior" and not isinstance(value, str):
            found += _prior(value)
        elif isinstance(value, Mapping):
            entries = [f"{_word(name, key)}={_word(name, entry)}" for key, entry in value.items()]
            found += [f"{option}={entry}" for entry in entries] if name in _REPEATED else [f"{option}={','.join(entries)}"]
        elif isinstance(value, (str, os.PathLike)) or not isinstance(value, Iterable):
            found.append(f"{option}={_word(name, value)}")
        else:
            found.append(f"{option}={','.join(_word(name, entry) for entry in value)}")
    return found


def search(options: Mapping[str, Any], caller: str) -> list[str]:
    """Those of `Search`."""
    return words(options, Search.__annotations__, caller)


def reading(options: Mapping[str, Any], caller: str) -> list[str]:
    """Those of `Reading`."""
    return words(options, Reading.__annotations__, caller)


def _bounds(bounds: Any) -> list[str]:
    if not isinstance(bounds, Mapping):
        raise ValueError('bounds is not a mapping; write bounds={"n": (1, 2), "kappa": 0}')
    found = []
    for name, bound in bounds.items():
        limits = np.asarray(bound)
        if limits.shape not in ((), (2,)) or limits.dtype.kind not in "fiu":
            raise ValueError(
                f"bounds[{name!r}] is {bound!r}; give (least, largest), or the number at which it is fixed"
            )
        if limits.shape == ():
            found.append(f"--fix={name}={float(limits)!r}")
        else:
            lower, upper = limits.tolist()
            if lower > upper:
                raise ValueError(f"the bounds of {name} are the wrong way round; write {name!r}: ({upper}, {lower})")
            found.append(f"--bounds={name}={float(lower)!r}:{float(upper)!r}")
    return found


def _prior(prior: Any) -> list[str]:
    if not isinstance(prior, Mapping):
        raise ValueError('prior is not a mapping; write prior={"n": (1.5, 0.02)}')
    found = []
    for name, known in prior.items():
        if not isinstance(known, str):
            pair = np.asarray(known)
            if pair.shape != (2,) or pair.dtype.kind not in "fiu":
                raise ValueError(f"prior[{name!r}] is {known!r}; give (value, standard error)")
            known = "{!r}+-{!r}".format(*map(float, pair))
        found.append(f"--prior={name}={known}")
    return found


def whole(name: str, value: Any, least: int, largest: int) -> int:
    """A whole number."""
    try:
        number = operator.index(value)
    except TypeError:
        number = least - 1
    if isinstance(value, bool) or not least <= number <= largest:
        raise ValueError(f"{name} is {value!r}; take a whole number from {least} to {largest}")
    return number


def flag(name: str, value: Any) -> bool:
    """True or False; NumPy's too."""
    if not isinstance(value, (bool, np.bool_)):
        raise ValueError(f"{name} is {value!r}; take True or False")
    return bool(value)


def between(name: str, value: Any, largest: float, what: str) -> float:
    """A number above 0 and below the largest; `what` says what to take."""
    try:
        number = float(value)
    except (TypeError, ValueError):
        number = 0.0
    if not 0 < number < largest:
        raise ValueError(f"{name} is {value!r}; take {what}")
    return number


def _word(name: str, value: Any) -> str:
    if isinstance(value, (str, os.PathLike)):
        return os.fspath(value)
    if isinstance(value, bool):
        raise ValueError(f"{name} cannot be {value}")
    try:
        return str(operator.index(value))
    except TypeError:
        pass
    try:
        return repr(float(value))
    except (TypeError, ValueError):
        raise ValueError(f"{name} cannot be {value!r}") from None


def in_python(text: str) -> str:
    """What the program says of its options, in the words of Python."""

    def name(option: re.Match[str]) -> str:
        return (option[1] or option[2]).replace("-", "_")

    # As a whole with its placeholder, or alone.
    return re.sub(r"'--([a-z][a-z0-9-]*)(?: <[^>]*>)?'|(?<![^\s(])--([a-z][a-z0-9-]*)", name, text)
