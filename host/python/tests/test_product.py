"""What the program does beyond a fit, from Python: with its numbers."""

import json
import pickle
import sys

import numpy as np
import pytest

import brdfit

from common import DATA, program, scan

FILE = DATA / "testdata1_sym_seed1.csv"


@pytest.fixture(scope="module")
def read():
    (one,) = brdfit.read(FILE)
    return one


@pytest.fixture(scope="module")
def fitted(read):
    return brdfit.fit(read)


def same(details, printed):
    """Both are the same object, apart from what the file is called."""
    for it in (details, printed):
        it.pop("file", None)
        it.pop("scan", None)
        it.pop("provenance", None)
        for one in it.get("scans", []):
            one.pop("scan", None), one.pop("provenance", None)
    assert details == printed


def test_a_file_has_the_bits_of_its_numbers(read, fitted):
    theta_i, theta_s, measured = scan(FILE.name)
    assert [read.theta_i.tolist(), read.theta_s.tolist()] == [theta_i.tolist(), theta_s.tolist()]
    assert read.brdf.tolist() == measured.tolist() and len(read) == 171 and read.file == str(FILE)
    assert (read.delta_phi == 180).all() and (read.weight == 1).all() and read.sigma_ln is None
    assert repr(read) == f"brdfit.Scan: {FILE}, 171 samples at theta_i = 45 deg"
    assert fitted.x.tobytes() == brdfit.fit(theta_i, theta_s, measured).x.tobytes()
    assert fitted.details == json.loads(program("fit", FILE, "--format", "json"))


def test_reading_takes_the_program_s_options(tmp_path):
    rows = [f"{theta_s},{30},{value},{2 * value}" for theta_s, value in zip(range(-40, 60, 2), np.linspace(0.1, 0.2, 50))]
    file = tmp_path / "scan.csv"
    file.write_text("\n".join(["a,b,R,G", *rows]))
    scans = brdfit.read(file, columns={"theta_s": 1, "theta_i": 2, "brdf": 4}, ignore="R", mask_retro=5, thin=2)
    assert len(scans) == 1 and scans[0].brdf[0] == 0.2
    assert {why for why, *_ in scans[0].left_out} == {"near retro"}
    with pytest.raises(brdfit.Error, match="scan.csv:") as caught:
        brdfit.read(file)
    assert caught.value.kind == "input" and caught.value.file == str(file)
    assert pickle.loads(pickle.dumps(caught.value)).file == str(file)
    with pytest.raises(TypeError, match=r"^read\(\) has no option 'colour'; its options are input_format, "):
        brdfit.read(file, colour="R")
    with pytest.raises(brdfit.Error, match="none.csv: ") as caught:
        brdfit.read(tmp_path / "none.csv")
    assert caught.value.kind == "file" and caught.value.line is None
    with pytest.raises(brdfit.Error, match="^invalid value 'best' for method ") as caught:
        brdfit.fit(scans[0], method="best")
    assert caught.value.kind == "options" and caught.value.file is None


def test_what_follows_from_a_fit(read, fitted):
    assert np.sum(fitted.residuals**2) == pytest.approx(fitted.fun, rel=1e-12)
    assert fitted.curve().tolist() == brdfit.brdf(read.theta_i, read.theta_s, fitted).tolist()
    assert fitted.curve([0, 30]).tolist() == brdfit.brdf(45, [0, 30], fitted.parameters).tolist()
    (at,) = fitted.derived
    assert at["theta_i_deg"] == 45 and at["reflectance"]["value"] > 1 and not at["energy_conserved"]
    assert len(fitted.undetermined) == 1 and fitted.undetermined[0].startswith("rho_s, rho_v, n and kappa only ")
    assert fitted.hints == []


def test_what_follows_is_seen_by_the_instrument(read):
    truth = {"rho_d": 0.1, "rho_s": 10, "m": 0.1, "n": 3, "kappa": 1}
    shifted = brdfit.brdf(45, read.theta_s - 1, truth)
    fit = brdfit.fit(45, read.theta_s, shifted, fit_offset=True)
    assert fit.offset == pytest.approx(1, abs=1e-6) and fit.offset == fit.table["offset_deg"]
    assert np.sum(fit.residuals**2) < 1e-12 and fit.curve() == pytest.approx(shifted, rel=1e-6)
    # That of the material has neither offset nor aperture.
    assert brdfit.brdf(45, 30, fit) == pytest.approx(brdfit.brdf(45, 30, truth), rel=1e-6)
    file = read_back(fit)
    assert file.residuals.tobytes() == fit.residuals.tobytes() and file.svg() == fit.svg()
    drawn = brdfit.fit(45, read.theta_s - 1, shifted)
    assert fit.svg().count("<circle") == drawn.svg().count("<circle")

    wide = brdfit.fit(read, aperture_half_angle=2, starts=1)
    assert wide.aperture_half_angle == pytest.approx(2, rel=1e-14)
    assert np.sum(wide.residuals**2) == pytest.approx(wide.fun, rel=1e-9)
    assert np.sum(np.log(wide.curve() / read.brdf) ** 2) == pytest.approx(wide.fun, rel=1e-9)


def read_back(fit):
    return pickle.loads(pickle.dumps(fit))


@pytest.mark.parametrize("options", [{}, {"robust": True}, {"prior": {"n": (1.5, 0.02)}}])
def test_residuals_are_what_is_minimised(read, options):
    for sigma in (None, 0.1 * read.brdf + 0.001):
        fit = brdfit.fit(read.theta_i, read.theta_s, read.brdf, sigma=sigma, **options)
        kept = np.delete(fit.residuals, fit.outliers)
        pull = 0 if "prior" not in options else fit.fun - np.sum(kept**2)
        assert pull >= 0 and np.sum(kept**2) + pull == pytest.approx(fit.fun, rel=1e-9)


def test_models_by_name(read, fitted):
    assert list(brdfit.MODELS)[:2] == ["beckmann", "beckmann-smith"]
    for name in ("ggx-second", "abg"):
        result = brdfit.fit(read, model=name)
        printed = json.loads(program("fit", FILE, "--model", name, "--format", "json"))
        assert result.parameters == printed["parameters"] and result.model == name
        values = brdfit.brdf(read.theta_i, read.theta_s, result.parameters, model=name)
        assert values.tolist() == brdfit.brdf(read.theta_i, read.theta_s, result).tolist()
        assert repr(result).startswith(f"brdfit.Fit of {name}: ")
    chosen = brdfit.fit(read, model="beckmann,ggx", terms="auto")
    assert chosen.model == "beckmann" and chosen.table["terms"] == ["diffuse", "surface", "volume"]
    assert chosen.details["selection"]["criterion"] == "bic"


def test_certificate():
    file = DATA / "testdata3_sym_seed1.csv"
    (one,) = brdfit.read(file)
    result = brdfit.fit(one, certify=0.5)
    printed = program("fit", file, "--certify", "0.5", "--format", "json")
    assert result.certificate == json.loads(printed)["certificate"] and result.certificate["complete"]
    assert brdfit.fit(one).certificate is None
    assert not brdfit.fit(one, certify=0.001, proof_boxes=1).details["certificate"]
    with pytest.raises(ValueError, match="^certify is 2; take a part above 0 and below 1"):
        brdfit.fit(one, certify=2)
    with pytest.raises(ValueError, match="^there is no proof of the optimum for the model ggx; "):
        brdfit.fit(one, certify=0.5, model="ggx")


def test_robust(read):
    brdf = read.brdf
    brdf[[20, 50]] *= 30
    result = brdfit.fit(read.theta_i, read.theta_s, brdf, robust=True)
    assert result.outliers == (20, 50) and result.samples == 169
    assert len(result.residuals) == 171 and abs(result.residuals[20]) > 3


def test_many_with_options_of_their_own(read):
    each = [{"terms": "diffuse,surface"}, {"model": "ggx-second", "seed": 3}, {"bounds": {"n": 1.5}}]
    many = brdfit.fit_many(45, read.theta_s, [read.brdf] * 3, each=each, starts=200)
    assert many.names == (*brdfit.NAMES, "rho_2", "m_2")
    assert many.model.tolist() == ["beckmann", "ggx-second", "beckmann"] and many.terms[0] == "diffuse,surface"
    for k, options in enumerate(each):
        one = brdfit.fit(read, starts=200, **options)
        places = [many.names.index(name) for name in one.names]
        assert many.x[k, places].tolist() == one.x.tolist()
        assert many.cov[k][np.ix_(places, places)].tobytes() == one.cov.tobytes()
        assert np.isnan(np.delete(many.x[k], places)).all()
    with pytest.raises(ValueError, match="^each has options for 2 scans, and brdf has 3$"):
        brdfit.fit_many(45, read.theta_s, [read.brdf] * 3, each=each[:2])
    curves = brdfit.brdf(45, [0, 30], brdfit.fit_many(45, read.theta_s, [read.brdf] * 3))
    assert curves.shape == (3, 2)


def test_profile_and_bootstrap(read, fitted):
    found = brdfit.profile(read, ["m", "n"], bootstrap=20)
    same(found.details, json.loads(program(
        "profile", FILE, "--parameter", "m,n", "--bootstrap", "20", "--format", "json"
    )))
    interval = found["m"].intervals[1]
    assert interval.level == 0.95 and interval.low < fitted.parameters["m"] < interval.high
    assert found["m"].rise.min() == 0 and found["m"].x.shape == (len(found["m"].value), 6)
    assert found.bootstrap["m"][0] == pytest.approx(fitted.parameters["m"], rel=0.01)
    assert brdfit.profile(fitted, "m").cost == found.cost
    with pytest.raises(ValueError, match="'x' is not a free parameter of the terms diffuse,"):
        brdfit.profile(read, "x")
    with pytest.raises(TypeError, match="^this takes a Scan or a Fit, not list; brdfit.scan makes one of arrays$"):
        brdfit.profile([1, 2])


def test_compare(read):
    found = brdfit.compare(read, ["ggx", "beckmann"])
    printed = json.loads(program("compare", FILE, "--models", "ggx,beckmann", "--format", "json"))
    assert found.model == printed["model"] == "beckmann" and found.models == printed["models"]
    table = pytest.importorskip("pandas") and found.to_pandas()
    assert list(table.index) == ["beckmann", "ggx"]


def test_joint(read):
    other = DATA / "testdata1_sym_seed2.csv"
    found = brdfit.joint([read, *brdfit.read(other)], "m,n", terms="diffuse,surface")
    printed = program("joint", FILE, other, "--share", "m,n", "--terms", "diffuse,surface", "--format", "json")
    same(found.details, json.loads(printed))
    assert found.shared == ("m", "n") and found.parameters[0]["m"] == found.parameters[1]["m"]
    assert list(found.parameters[0]) == list(brdfit.NAMES)


def test_joint_repeats(read):
    others = [DATA / f"testdata1_sym_seed{seed}.csv" for seed in (2, 3)]
    found = brdfit.joint([read, *brdfit.read(others)], repeats=True, scale_uncertainty=0.03)
    printed = program("joint", FILE, *others, "--repeats", "--scale-uncertainty", "3%", "--format", "json")
    printed = json.loads(printed)
    assert found.quantities == printed["quantities"] and found.model == "beckmann"
    table = pytest.importorskip("pandas") and found.to_pandas()
    assert table["expanded"][0] == printed["quantities"][0]["budget"]["expanded"]
    with pytest.raises(brdfit.Error, match="^repeats fits each run alone"):
        brdfit.joint([read, read], "m", repeats=True)
    with pytest.raises(TypeError, match=r"^joint\(\) takes several scans, or fits, in a list$"):
        brdfit.joint(read)


def test_one_material_of_three_scans(tmp_path):
    files = [DATA / f"testdata{number}_sym_seed1.csv" for number in (1, 2, 3)]
    fits = [brdfit.fit(one) for one in brdfit.read(files)]
    (tmp_path / "rgb.json").write_text(program("fit", *files, "--format", "json"))
    assert brdfit.export(fits, "gltf") == program("export", tmp_path / "rgb.json", "--to", "gltf")
    assert brdfit.export(fits, "c", index=2) == brdfit.export(fits[1], "c")
    table = "".join(
        f"{i},{s},{wavelength},{f * wavelength / 500}\n" for wavelength in (450, 550) for i, s, f in scan(FILE.name).T
    )
    (tmp_path / "two.csv").write_text("theta_i_deg,theta_s_deg,wavelength_nm,brdf_per_sr\n" + table)
    two = [brdfit.fit(one) for one in brdfit.read(tmp_path / "two.csv")]
    tensors = brdfit.export(two, "rgl")
    bare = [brdfit.fit(one.scan.theta_i, one.scan.theta_s, one.scan.brdf) for one in two]
    assert len(tensors) > 1.2 * len(brdfit.export(two[0], "rgl"))
    named = brdfit.export(bare, "rgl", wavelength=[450, 550])
    assert all(np.float32([450, 550]).tobytes() in both for both in (tensors, named))
    with pytest.raises(ValueError, match="^wavelength has 3 numbers for 2 fits; give one for each$"):
        brdfit.export(bare, "rgl", wavelength=[450, 550, 650])
    with pytest.raises(TypeError, match=r"^export\(\) takes a Fit, or several in a list$"):
        brdfit.export(["a"], "c")


@pytest.mark.parametrize("package, call", [
    ("pandas", "fit.to_pandas()"),
    ("pandas", "many.to_pandas()"),
    ("xarray", "many.to_xarray()"),
    ("matplotlib", "fit.plot()"),
])
def test_what_is_missing_is_named(read, monkeypatch, package, call):
    known = {"fit": brdfit.fit(read, starts=1), "many": brdfit.fit_many(45, read.theta_s, [read.brdf], starts=1)}
    for name in [name for name in sys.modules if name.partition(".")[0] == package]:
        monkeypatch.delitem(sys.modules, name)
    monkeypatch.setattr(sys, "meta_path", [Hidden(package), *sys.meta_path])
    with pytest.raises(ModuleNotFoundError, match=f"needs {package}, which is not installed; get it with: pip install {package}$"):
        eval(call, known)


class Hidden:
    """Finds nothing of a package."""

    def __init__(self, package):
        self.package = package

    def find_spec(self, name, path=None, target=None):
        if name.partition(".")[0] == self.package:
            raise ModuleNotFoundError(f"No module named {name!r}", name=self.package)


def test_weights_and_outliers_reach_the_studies(read):
    sigma = read.brdf * (0.02 + 0.1 * np.abs(np.sin(read.theta_s)))
    weighted = brdfit.fit(read.theta_i, read.theta_s, read.brdf, sigma=sigma)
    assert weighted.scan.sigma_ln > 0 and weighted.table["chi2"] > 0
    assert brdfit.profile(weighted, "m").cost == weighted.fun


def test_a_page_weighs_standard_deviations_as_a_fit_does(read):
    fit = brdfit.fit(read.theta_i, read.theta_s, read.brdf, sigma=0.1 * read.brdf + 0.001)
    assert f"{fit.x[0]:.4g}" in brdfit.report(fit)


def test_page_exports_and_notebooks(read, fitted, tmp_path):
    page = brdfit.report(fitted, tmp_path / "page.html")
    assert page.startswith("<!DOCTYPE html>") and (tmp_path / "page.html").read_text() == page
    assert fitted.export("c", tmp_path / "paint.h", name="paint") == (tmp_path / "paint.h").read_text()
    result = tmp_path / "result.json"
    result.write_text(fitted.json)
    assert fitted.export("zemax") == program("export", result, "--to", "zemax")
    with pytest.raises(ValueError, match="wavelength"):
        fitted.export("openmaterial")
    tensors = fitted.export("rgl", tmp_path / "paint.bsdf", wavelength=550)
    assert isinstance(tensors, bytes) and (tmp_path / "paint.bsdf").read_bytes() == tensors
    assert brdfit.export(fitted, "rgl", wavelength=550) == tensors
    fitted.export("openmaterial", tmp_path / "paint.openmaterial", wavelength=550)
    for form in ("bird", "zemax"):
        fitted.export(form, tmp_path / f"paint.{form}")
    # Angles and values of RGL are in single precision, and Zemax has ten digits.
    for form, error in {"bsdf": 3e-4, "openmaterial": 1e-12, "bird": 1e-12, "zemax": 1e-9}.items():
        (back,) = brdfit.read(tmp_path / f"paint.{form}")
        expected = brdfit.brdf(back.theta_i, back.theta_s, fitted, delta_phi=back.delta_phi)
        np.testing.assert_allclose(back.brdf, expected, rtol=error)
    with pytest.raises(ValueError, match="^invalid value 'blender' for to "):
        fitted.export("blender")
    html = fitted._repr_html_()
    assert "<td>rho_d</td><td>0.101916</td>" in html and "<svg" in html


def test_plot(fitted):
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("agg")
    ax = fitted.plot()
    curve, points, left_out = ax.lines
    assert len(points.get_xdata()) == 171 and len(left_out.get_xdata()) == 0
    at = np.searchsorted(curve.get_xdata(), fitted.scan.theta_s)
    assert curve.get_ydata()[at].tolist() == fitted.curve().tolist()


def test_progress(read, capsys):
    pytest.importorskip("tqdm")
    brdfit.fit_many(45, read.theta_s, [read.brdf] * 3, progress=True)
    assert "3/3" in capsys.readouterr().err


def test_progress_without_tqdm(read, monkeypatch):
    for name in [name for name in sys.modules if name.partition(".")[0] == "tqdm"]:
        monkeypatch.delitem(sys.modules, name)
    monkeypatch.setattr(sys, "meta_path", [Hidden("tqdm"), *sys.meta_path])
    with pytest.warns(UserWarning, match="^progress=True needs tqdm, .* pip install tqdm; it goes on without$"):
        brdfit.fit_many(45, read.theta_s, [read.brdf], progress=True, starts=1)
