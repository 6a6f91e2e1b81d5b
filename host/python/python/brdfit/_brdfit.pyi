"""The native half: arrays of shape (scans, samples), angles in degrees, BRDF in sr^-1, options as words of the command line."""

import os
from collections.abc import Callable, Mapping, Sequence
from typing import Any, final

import numpy as np
from numpy.typing import NDArray

__all__ = [
    "Scan",
    "brdf",
    "command",
    "fit",
    "fit_many",
    "main",
    "models",
    "names",
    "picture",
    "read",
    "read_bytes",
    "report",
    "scan",
    "table",
]

_Numbers = NDArray[np.float64]
_Arrays = Mapping[str, Any]
# The part that no cost may be below the fit's, the most boxes, the longest time in seconds.
_Claim = tuple[float, int | None, float | None]

@final
class Scan:
    """A measured scan: samples in degrees and sr^-1, with what was left out of it."""

    @property
    def theta_i(self) -> _Numbers:
        """Angles of incidence, degrees."""
    @property
    def theta_s(self) -> _Numbers:
        """Scattering angles, degrees."""
    @property
    def delta_phi(self) -> _Numbers:
        """Azimuths of scattering less those of incidence, degrees."""
    @property
    def brdf(self) -> _Numbers:
        """Measured BRDF, sr^-1."""
    @property
    def weight(self) -> _Numbers:
        """Factors of the residuals, whose squares have a mean of 1."""
    @property
    def sigma_ln(self) -> float | None:
        """The standard deviation of ln BRDF that a weight of 1 stands for, or None."""
    @property
    def file(self) -> str:
        """The file, or what messages call the scan."""
    @property
    def name(self) -> str | None:
        """Which scan of the file it is, or None."""
    @property
    def left_out(self) -> list[tuple[str, float, int]]:
        """What was left out: the reason, the angle of incidence in degrees, and how many samples."""
    @property
    def notes(self) -> list[str]:
        """What was done to the numbers of the file, and what may be wrong with it."""
    @property
    def not_used(self) -> list[str]:
        """Columns of the file that are not used."""
    def table(self) -> str:
        """The scan as the program's own table, which reads back to the same bits."""
    def __len__(self) -> int: ...

def scan(arrays: _Arrays, drop_invalid: bool, name: str) -> Scan: ...
def read(paths: Sequence[str | os.PathLike[str]], words: Sequence[str]) -> list[Scan]: ...
def read_bytes(name: str, bytes: bytes, words: Sequence[str]) -> list[Scan]: ...
def table(scans: Sequence[Scan]) -> str: ...
def fit(scan: Scan, words: Sequence[str], claim: _Claim | None) -> dict[str, Any]: ...
def fit_many(
    arrays: _Arrays,
    words: Sequence[Sequence[str]],
    drop_invalid: bool,
    progress: Callable[[int], object] | None,
) -> dict[str, Any]: ...
def brdf(
    model: str, angles: Sequence[_Numbers], x: _Numbers, ln: bool, seen: tuple[float, float]
) -> _Numbers: ...
def report(scans: Sequence[Scan], words: Sequence[str], claim: _Claim | None, told: str) -> str: ...
def picture(scan: Scan, title: str, model: str, minima: Sequence[Sequence[float]], outliers: Sequence[int], offset: float) -> str: ...
def models() -> list[tuple[str, str]]: ...
def names(model: str) -> list[tuple[str, str, str, float]]: ...
def command(words: Sequence[str], input: bytes) -> bytes: ...
def main(words: Sequence[str]) -> int: ...
