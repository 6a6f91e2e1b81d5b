"""The native half: arrays of shape (scans, samples), angles in degrees, BRDF in sr^-1."""

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

__all__ = ["brdf", "fit", "fit_many"]

_Array = NDArray[np.float64]

def fit(arrays: Mapping[str, _Array | None], settings: Mapping[str, object]) -> dict[str, Any]: ...
def fit_many(arrays: Mapping[str, _Array | None], settings: Mapping[str, object], threads: int) -> dict[str, Any]: ...
def brdf(theta_i: _Array, theta_s: _Array, delta_phi: _Array, x: _Array, ln: bool) -> _Array: ...
