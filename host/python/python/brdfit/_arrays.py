"""Arrays as the native half takes them: what it would get wrong is refused here."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

Numbers = NDArray[np.float64]

DEGREES, PER_SR = "degree", "1/steradian"
_ASTROPY = {DEGREES: "deg", PER_SR: "1 / sr"}


def array(name: str, value: Any, unit: str | None = None) -> tuple[Numbers, NDArray[np.bool_] | None]:
    """The numbers of `value`, in `unit` if it has one of its own, and where it is masked."""
    value = _in_unit(name, value, unit)
    mask = np.ma.getmaskarray(value) if isinstance(value, np.ma.MaskedArray) else None
    try:
        plain = np.asarray(np.ma.getdata(value) if mask is not None else value)
    except (TypeError, ValueError) as error:
        raise ValueError(f"{name} is not an array of numbers: {error}") from None
    if plain.dtype.kind not in "fiu" and plain.size > 0:
        raise ValueError(f"{name} is not an array of numbers: its type is {plain.dtype}; give real numbers")
    numbers = np.asarray(plain, dtype=np.float64)
    # Steps between the numbers, as in a field of a record: other libraries would read between them.
    if not numbers.flags.aligned or any(step % numbers.itemsize for step in numbers.strides):
        numbers = numbers.copy()
    return numbers, mask


def numbers(name: str, value: Any, unit: str | None = None) -> Numbers:
    """The same where nothing can be masked."""
    found, mask = array(name, value, unit)
    if mask is not None and mask.any():
        raise ValueError(f"{name} is masked; give numbers, or NaN")
    return found


def _in_unit(name: str, value: Any, unit: str | None) -> Any:
    # The buffer of an array of dates is an error in itself.
    inner = None if isinstance(value, np.ndarray) else getattr(value, "data", None)
    if hasattr(inner, "magnitude"):
        # An xarray.DataArray of quantities.
        value = inner
    try:
        if hasattr(value, "magnitude") and hasattr(value, "to"):
            return value.to(unit or "dimensionless").magnitude
        if hasattr(value, "to_value") and hasattr(value, "unit"):
            return value.to_value(_ASTROPY.get(unit or "", ""))
    except Exception as error:
        raise ValueError(f"{name} is not in a unit of {unit or 'numbers'}: {error}") from None
    return value


def azimuth(delta_phi: ArrayLike | None) -> tuple[Numbers, NDArray[np.bool_] | None]:
    """Azimuths in degrees; by default all is in plane."""
    return array("delta_phi", 180.0 if delta_phi is None else delta_phi, DEGREES)


def broadcast(names: Iterable[str], shapes: list[tuple[int, ...]]) -> tuple[int, ...]:
    """The shape to which all shapes broadcast."""
    try:
        return np.broadcast_shapes(*shapes)
    except ValueError:
        each = ", ".join(f"{name} {shape}" for name, shape in zip(names, shapes))
        raise ValueError(f"the shapes do not broadcast: {each}") from None


def together(
    theta_i: ArrayLike,
    theta_s: ArrayLike,
    brdf: ArrayLike,
    delta_phi: ArrayLike | None,
    sigma: ArrayLike | None,
    mask: ArrayLike | None,
) -> dict[str, NDArray[Any]]:
    """All arrays in the shape of `brdf`, with one mask if anything is masked."""
    found = {
        "theta_i": array("theta_i", theta_i, DEGREES),
        "theta_s": array("theta_s", theta_s, DEGREES),
        "delta_phi": azimuth(delta_phi),
        "brdf": array("brdf", brdf, PER_SR),
    }
    if sigma is not None:
        found["sigma"] = array("sigma", sigma, PER_SR)
    arrays: dict[str, NDArray[Any]] = {name: values for name, (values, _) in found.items()}
    masks = [one for _, one in found.values() if one is not None and one.any()]
    if mask is not None:
        given = np.asarray(mask)
        if given.dtype != np.bool_:
            raise ValueError(f"mask has the type {given.dtype}; give True where a sample is to be left out")
        arrays["mask"] = given
    shape = broadcast(arrays, [values.shape for values in arrays.values()])
    measured = arrays["brdf"].shape
    if shape != measured:
        raise ValueError(f"brdf has the shape {measured}, the others ask for {shape}; give one BRDF a sample")
    if measured and measured[-1] == 0:
        raise ValueError("brdf has no samples")
    for one in masks:
        arrays["mask"] = arrays.get("mask", np.zeros(shape, np.bool_)) | one
    return {name: np.broadcast_to(values, shape) for name, values in arrays.items()}


def rows(arrays: dict[str, NDArray[Any]]) -> dict[str, NDArray[Any] | None]:
    """The same in shape (scans, samples)."""
    shape = arrays["brdf"].shape
    scans = int(np.prod(shape[:-1]))
    flat: dict[str, NDArray[Any] | None] = {"sigma": None, "mask": None}
    for name, values in arrays.items():
        flat[name] = values.reshape(scans, shape[-1])
    return flat
