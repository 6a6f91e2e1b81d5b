"""Arrays as the native half takes them: what it would get wrong is refused here."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

Numbers = NDArray[np.float64]
Angles = Literal["deg", "rad"]

DEGREES, PER_SR = "degree", "1/steradian"
_ASTROPY = {DEGREES: "deg", PER_SR: "1 / sr"}


def array(name: str, value: Any, unit: str | None = None) -> tuple[Numbers, NDArray[np.bool_] | None]:
    """The numbers of `value`, in `unit` if it has one of its own, and where it is masked."""
    value = in_unit(name, value, unit)
    mask = np.ma.getmaskarray(value) if isinstance(value, np.ma.MaskedArray) else None
    try:
        plain = np.asarray(np.ma.getdata(value) if mask is not None else value)
        if has_unit(plain):
            # Such as a column of pandas whose cells are quantities.
            plain = np.asarray(in_unit(name, plain.tolist(), unit))
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


def _quantity(value: Any) -> Any:
    """The quantity of pint or astropy that a value is, or None."""
    # The buffer of an array of dates is an error in itself.
    inner = None if isinstance(value, (np.ndarray, np.generic)) else getattr(value, "data", None)
    # The first is an xarray.DataArray of quantities.
    for one in (inner, value):
        if hasattr(one, "magnitude") and hasattr(one, "to") or hasattr(one, "to_value") and hasattr(one, "unit"):
            return one
    return None


def _is_list(value: Any) -> bool:
    return isinstance(value, Sequence) and not isinstance(value, (str, bytes))


def has_unit(value: Any) -> bool:
    """Whether a value, or one in it, has a unit of its own."""
    if isinstance(value, np.ndarray) and value.dtype.kind == "O" and value.ndim > 0:
        value = value.ravel().tolist()
    if _is_list(value):
        return any(has_unit(one) for one in value if type(one) not in (float, int))
    return _quantity(value) is not None


def in_unit(name: str, value: Any, unit: str | None) -> Any:
    """The numbers of quantities in `unit`; what has no unit of its own as it is."""
    if not has_unit(value):
        return value
    if _is_list(value):
        # NumPy would take the numbers of quantities in a list as they stand, whatever their units.
        return [in_unit(name, one, unit) for one in value]
    quantity = _quantity(value)
    if quantity is None:
        return value
    try:
        if hasattr(quantity, "to_value"):
            return quantity.to_value(_ASTROPY.get(unit or "", unit or ""))
        of = type(quantity)
        # To pint angles, solid angles and plain numbers are all alike.
        if not (of(1, quantity.units) / of(1, unit or "dimensionless")).unitless:
            raise ValueError(f"its unit is {quantity.units}")
        return quantity.to(unit or "dimensionless").magnitude
    except Exception as error:
        raise ValueError(f"{name} is not in a unit of {unit or 'numbers'}: {error}") from None


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
    angles: Angles | None,
) -> tuple[dict[str, NDArray[Any]], list[str]]:
    """All arrays in the shape of `brdf`, with one mask if anything is masked; and the names of those that may be radians, for all that was said of them."""
    if angles not in (None, "deg", "rad"):
        raise ValueError(f'angles is {angles!r}; take "deg" or "rad"')
    given = {"theta_i": theta_i, "theta_s": theta_s} | ({} if delta_phi is None else {"delta_phi": delta_phi})
    bare = [name for name, value in given.items() if not has_unit(value)]
    found = {
        "theta_i": array("theta_i", theta_i, DEGREES),
        "theta_s": array("theta_s", theta_s, DEGREES),
        "delta_phi": azimuth(delta_phi),
        "brdf": array("brdf", brdf, PER_SR),
    }
    if angles == "rad":
        found |= {name: (np.degrees(found[name][0]), found[name][1]) for name in bare}
    # As the reader has it, one angle for all is given on purpose, whatever its size; azimuths are seen by pi.
    asked = [name for name in bare if angles is None and (found[name][0].ndim > 0 or name == "delta_phi")]
    if sigma is not None:
        found["sigma"] = array("sigma", sigma, PER_SR)
    arrays: dict[str, NDArray[Any]] = {name: values for name, (values, _) in found.items()}
    masks = [one for _, one in found.values() if one is not None and one.any()]
    if mask is not None:
        where = np.asarray(mask)
        if where.dtype != np.bool_:
            raise ValueError(f"mask has the type {where.dtype}; give True where a sample is to be left out")
        if isinstance(mask, np.ma.MaskedArray) and np.ma.getmaskarray(mask).any():
            raise ValueError("mask is masked itself; give True where a sample is to be left out, else False")
        arrays["mask"] = where
    shape = broadcast(arrays, [values.shape for values in arrays.values()])
    measured = arrays["brdf"].shape
    if shape != measured:
        raise ValueError(f"brdf has the shape {measured}, the others ask for {shape}; give one BRDF a sample")
    if measured and measured[-1] == 0:
        raise ValueError("brdf has no samples")
    for one in masks:
        arrays["mask"] = arrays.get("mask", np.zeros(shape, np.bool_)) | one
    return {name: np.broadcast_to(values, shape) for name, values in arrays.items()}, asked


def rows(arrays: dict[str, NDArray[Any]], asked: list[str]) -> dict[str, Any]:
    """The same in shape (scans, samples), as the native half takes them."""
    shape = arrays["brdf"].shape
    scans = int(np.prod(shape[:-1]))
    flat: dict[str, Any] = {"sigma": None, "mask": None, "asked": asked}
    for name, values in arrays.items():
        flat[name] = values.reshape(scans, shape[-1])
    return flat
