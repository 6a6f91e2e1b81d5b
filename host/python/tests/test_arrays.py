"""Arrays that other libraries read wrongly: they are read right, or refused."""

from collections import deque

import numpy as np
import pytest

import brdfit

from common import scan

THETA_I, THETA_S, MEASURED = scan("testdata1_sym_seed1.csv")


@pytest.fixture(scope="module")
def plain():
    return brdfit.fit(THETA_I, THETA_S, MEASURED)


@pytest.fixture(scope="module")
def kept():
    used = MEASURED < 2
    return brdfit.fit(THETA_I[used], THETA_S[used], MEASURED[used])


HIGH = MEASURED >= 2


@pytest.mark.parametrize("which", [0, 1, 2])
def test_masks_of_any_array_hold(which, kept):
    arrays = [THETA_I, THETA_S, MEASURED]
    # What lies under a mask may be anything.
    arrays[which] = np.ma.masked_array(np.where(HIGH, np.nan, arrays[which]), mask=HIGH)
    result = brdfit.fit(*arrays)
    assert result.x.tobytes() == kept.x.tobytes() and result.samples == kept.samples
    assert sum(count for why, _, count in result.scan.left_out if why == "masked") == 171 - kept.samples


def test_a_mask_of_its_own(kept):
    assert brdfit.fit(THETA_I, THETA_S, MEASURED, mask=HIGH).x.tobytes() == kept.x.tobytes()
    many = brdfit.fit_many(45, THETA_S, [MEASURED] * 2, mask=HIGH)
    assert many.x.tolist() == [kept.x.tolist()] * 2
    many = brdfit.fit_many(45, THETA_S, np.ma.masked_array([MEASURED] * 2, mask=[HIGH, np.zeros_like(HIGH)]))
    assert many.x[0].tolist() == kept.x.tolist() != many.x[1].tolist()


def test_a_masked_angle_has_no_brdf(plain):
    angles = np.ma.masked_array([0.0, np.nan, 95.0], mask=[False, True, True])
    values = brdfit.brdf(45, angles, plain)
    assert np.isnan(values).tolist() == [False, True, True]
    with pytest.raises(ValueError, match="^parameters is masked; "):
        brdfit.brdf(45, 0, np.ma.masked_array(plain.x, mask=[True] + [False] * 5))


def test_fields_of_records(plain):
    # Steps of 12 and 9 bytes, one of them out of line too.
    for kind in ([("f", "f8"), ("i", "i4")], [("flag", "u1"), ("f", "f8")]):
        records = np.zeros(171, dtype=kind)
        records["f"] = MEASURED
        assert brdfit.fit(THETA_I, THETA_S, records["f"]).x.tobytes() == plain.x.tobytes()
        assert brdfit.fit_many(45, THETA_S, records["f"][None]).x[0].tobytes() == plain.x.tobytes()


def test_the_native_half_refuses_what_it_would_misread():
    records = np.zeros(3, dtype=[("f", "f8"), ("i", "i4")])["f"]
    good = np.zeros(3)
    with pytest.raises(ValueError, match="^theta_s is not at whole steps in memory"):
        brdfit._brdfit.brdf("beckmann", [good, records, good], np.zeros((3, 6)), False, (0.0, 0.0))


@pytest.mark.parametrize("dtype", [">f8", "f4", "i8", "f2"])
def test_other_numbers_are_converted(dtype):
    values = np.round(MEASURED * 1000).clip(1).astype(dtype)
    expected = brdfit.fit(THETA_I, THETA_S, values.astype("f8"))
    assert brdfit.fit(THETA_I, THETA_S, values).x.tobytes() == expected.x.tobytes()
    backwards = brdfit.fit(THETA_I[::-1][::-1], THETA_S, values)
    assert backwards.x.tobytes() == expected.x.tobytes()


def test_units(plain):
    pint = pytest.importorskip("pint")
    unit = pint.UnitRegistry()
    radians = np.radians(THETA_S) * unit.radian
    result = brdfit.fit(45 * unit.degree, THETA_S * unit.degree, MEASURED / unit.steradian)
    assert result.x.tobytes() == plain.x.tobytes()
    assert brdfit.fit(45, radians, MEASURED).x == pytest.approx(plain.x, rel=1e-3)
    assert brdfit.brdf(np.pi / 4 * unit.radian, 0, plain) == pytest.approx(brdfit.brdf(45, 0, plain), rel=1e-14)
    with pytest.raises(ValueError, match="^theta_s is not in a unit of degree: "):
        brdfit.fit(45, THETA_S * unit.meter, MEASURED)


def test_lists_of_quantities(plain):
    pint = pytest.importorskip("pint")
    unit = pint.UnitRegistry()
    listed = [angle * unit.radian for angle in np.radians(THETA_S)]
    cells = np.empty(171, dtype=object)
    cells[:] = listed
    for angles in (listed, tuple(listed), deque(listed), cells):
        found = brdfit.scan(45, angles, [value / unit.steradian for value in MEASURED])
        assert found.theta_s == pytest.approx(THETA_S, abs=1e-12) and found.brdf.tolist() == MEASURED.tolist()
    many = brdfit.fit_many(45, THETA_S, [[value / unit.steradian for value in MEASURED]] * 2)
    assert many.x[1].tobytes() == plain.x.tobytes()
    masked = np.ma.masked_array(np.radians(THETA_S), mask=HIGH) * unit.radian
    assert len(brdfit.scan(45, masked, MEASURED)) == np.count_nonzero(~HIGH)


def test_units_of_something_else_are_refused():
    pint = pytest.importorskip("pint")
    unit = pint.UnitRegistry()
    for name, arguments in {
        "brdf": (45, THETA_S, MEASURED * unit.degree),
        "theta_i": (0.7 / unit.steradian, THETA_S, MEASURED),
        "theta_s": (45, [unit.Quantity(angle, "") for angle in THETA_S], MEASURED),
    }.items():
        with pytest.raises(ValueError, match=f"^{name} is not in a unit of .*: its unit is "):
            brdfit.scan(*arguments)
    with pytest.raises(ValueError, match="^seed is not in a unit of numbers: "):
        brdfit.fit(45, THETA_S, MEASURED, seed=3 * unit.meter)
    half = brdfit.fit(45, THETA_S, MEASURED, aperture_half_angle=unit.Quantity(30, "arcminute"), starts=1)
    assert half.aperture_half_angle == pytest.approx(0.5, rel=1e-14)


def test_radians_are_asked_about(tmp_path, plain):
    # As of a file with these numbers.
    radians = np.radians(THETA_S)
    for arguments in ((45, radians, MEASURED), (np.radians(THETA_I), radians, MEASURED)):
        with pytest.raises(ValueError, match=r"are they radians\?; say angles rad if they are, and angles deg if not"):
            brdfit.fit(*arguments)
        with pytest.raises(ValueError, match=r"are they radians\?"):
            brdfit.fit_many(*arguments[:2], [MEASURED])
    assert brdfit.fit(np.radians(THETA_I), radians, MEASURED, angles="rad").x == pytest.approx(plain.x, rel=1e-3)
    with pytest.raises(ValueError, match="^the azimuths are within 6.3 degrees and one is pi; "):
        brdfit.scan(45, THETA_S, MEASURED, delta_phi=np.pi)
    # A peak alone, in degrees, and one that is rightly in degrees.
    assert brdfit.scan(0, np.linspace(-1, 1, 171), MEASURED, angles="deg").theta_s[0] == -1
    assert len(brdfit.scan([1.0, 1.5], [10, 20], [1, 1])) == 2
    with pytest.raises(ValueError, match='^angles is \'grad\'; take "deg" or "rad"$'):
        brdfit.scan(45, THETA_S, MEASURED, angles="grad")


def test_units_of_astropy(plain):
    class Quantity:
        """What is asked of astropy.units.Quantity."""

        unit = "rad"

        def __init__(self, values):
            self.values = values

        def to_value(self, unit):
            assert unit in ("deg", "1 / sr")
            return np.degrees(self.values) if unit == "deg" else self.values

    result = brdfit.fit(45, Quantity(np.radians(THETA_S)), Quantity(MEASURED))
    assert result.x == pytest.approx(plain.x, rel=1e-3)


def test_pandas_and_xarray(plain):
    pd, xr = pytest.importorskip("pandas"), pytest.importorskip("xarray")
    frame = pd.DataFrame({"theta_i_deg": THETA_I, "theta_s_deg": THETA_S, "brdf_per_sr": MEASURED})
    assert brdfit.fit(frame.theta_i_deg, frame.theta_s_deg, frame.brdf_per_sr).x.tobytes() == plain.x.tobytes()
    assert brdfit.fit(brdfit.read(frame)[0]).x.tobytes() == plain.x.tobytes()
    assert plain.to_pandas()["rho_d"] == plain.x[0]
    cube = xr.DataArray(
        np.stack([[MEASURED, MEASURED * 2, MEASURED * 4]]),
        dims=("pixel", "wavelength", "theta_s"),
        coords={"wavelength": [450, 550, 650]},
    )
    many = brdfit.fit_many(45, THETA_S, cube)
    dataset = many.to_xarray()
    assert dataset.sizes["pixel"] == 1 and dataset.wavelength.values.tolist() == [450, 550, 650]
    assert dataset.rho_d.values.tobytes() == many.x[..., 0].tobytes()
    table = many.to_pandas()
    assert table.index.names == ["pixel", "wavelength"] and table.loc[(0, 650), "m"] == many.x[0, 2, 3]
