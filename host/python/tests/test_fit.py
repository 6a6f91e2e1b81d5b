"""Fits from Python: the same bits as the program's, one scan or many, and what is said of bad input."""

import itertools
import json
import multiprocessing
import pickle
import threading

import numpy as np
import pytest

import brdfit

from common import DATA, program, scan

SETS = [f"testdata{k}_sym_seed1.csv" for k in (1, 2, 3)]


def assert_same(result, printed):
    """`result` has the bits of the object that the program printed."""
    assert result.parameters == printed["parameters"]
    assert result.mse2 == printed["mse2"]
    assert result.samples == printed["samples"]
    assert list(result.at_bound) == printed["at_bound"]
    assert result.success == (printed["stop"] in ("cost", "step"))
    minima = [(minimum.mse2, minimum.parameters, minimum.hits) for minimum in result.minima]
    errors = dict(zip(brdfit.NAMES, result.stderr.tolist()))
    known = {name: error for name, error in printed["uncertainty"]["stderr"].items() if error is not None}
    assert known and known == {name: error for name, error in errors.items() if 0 < error < np.inf}
    for a, b in itertools.product(known, repeat=2):
        i, j = brdfit.NAMES.index(a), brdfit.NAMES.index(b)
        correlation = result.cov[i, j] / (errors[a] * errors[b])
        assert np.clip(correlation, -1, 1) == printed["uncertainty"]["correlation"][a][b]
    assert minima == [(it["mse2"], it["parameters"], it["hits"]) for it in printed["minima"]]


@pytest.mark.parametrize("name", SETS)
def test_the_bits_of_the_program(name):
    printed = json.loads(program("fit", DATA / name, "--format", "json"))
    assert_same(brdfit.fit(*scan(name)), printed)


@pytest.mark.parametrize(
    "options, keywords",
    [
        (["--seed", "7"], {"seed": 7}),
        (["--method", "paper"], {"method": "paper"}),
        (["--terms", "diffuse,surface", "--fix", "n=1.5"], {"terms": ["diffuse", "surface"], "bounds": {"n": 1.5}}),
        (["--bounds", "m=0.01:0.05", "--bounds", "kappa=1:2"], {"bounds": {"m": (0.01, 0.05), "kappa": [1, 2]}}),
    ],
)
def test_the_bits_of_the_program_with_options(options, keywords):
    printed = json.loads(program("fit", DATA / SETS[0], "--format", "json", *options))
    assert_same(brdfit.fit(*scan(SETS[0]), **keywords), printed)


def test_the_bits_of_the_program_out_of_plane(tmp_path):
    file = tmp_path / "scan.csv"
    angles = ["--theta-i", "30,60", "--theta-s", "-80:80:8", "--delta-phi", "180,150,-540.5"]
    program("simulate", *angles, "--rho-d", "0.1", "--rho-s", "5", "--noise", "0.1", "--output", file)
    theta_i, theta_s, delta_phi, brdf = np.loadtxt(file, delimiter=",", skiprows=1).T
    printed = json.loads(program("fit", file, "--format", "json"))
    assert_same(brdfit.fit(theta_i, theta_s, brdf, delta_phi=delta_phi), printed)


def test_the_bits_of_the_program_with_sigma(tmp_path):
    theta_i, theta_s, brdf = scan(SETS[0])
    sigma = brdf * (0.02 + 0.1 * np.abs(np.sin(theta_s)))
    file = tmp_path / "scan.csv"
    table = np.column_stack([theta_i, theta_s, brdf, sigma])
    np.savetxt(file, table, delimiter=",", header="theta_i,theta_s,brdf,sigma", comments="", fmt="%.17g")
    printed = json.loads(program("fit", file, "--format", "json"))
    result = brdfit.fit(theta_i, theta_s, brdf, sigma=sigma)
    assert_same(result, printed)
    assert result.x.tolist() != brdfit.fit(theta_i, theta_s, brdf).x.tolist()
    many = brdfit.fit_many(theta_i, theta_s, [brdf, brdf], sigma=[sigma, sigma])
    assert many.x.tolist() == [result.x.tolist()] * 2
    # Larger noise takes more from ln f on average, which is given back.
    assert brdfit.fit(theta_i, theta_s, brdf, sigma=sigma * 2).x[0] > result.x[0]


def test_prints_and_pickles():
    result = brdfit.fit(*scan(SETS[0]))
    assert "converged" in result.message and result.message in repr(result)
    assert f"m      {result.parameters['m']:14.6g}" in repr(result)
    again = pickle.loads(pickle.dumps(result))
    assert repr(again) == repr(result) and again.x.tobytes() == result.x.tobytes()
    assert again.minima[0].parameters == result.parameters


@pytest.fixture(scope="module")
def cube():
    """theta_s of shape (60), and BRDF of shape (2, 3, 60)."""
    random = np.random.default_rng(1)
    theta_s = np.linspace(-80, 80, 60)
    x = random.uniform([0.01, 1, 0, 0.05, 1.2, 0.1], [0.1, 20, 0.1, 0.3, 3, 3], (2, 3, 1, 6))
    return theta_s, brdfit.brdf(30, theta_s, x) * random.uniform(0.9, 1.1, (2, 3, 60))


def test_many_are_each_as_one(cube):
    theta_s, measured = cube
    many = brdfit.fit_many(30, theta_s, measured)
    assert many.x.shape == (2, 3, 6) and many.fun.shape == (2, 3)
    assert many.success.all() and "6 of 6 scans converged" in repr(many)
    for place in np.ndindex(2, 3):
        one = brdfit.fit(30, theta_s, measured[place])
        for name in ("x", "cov", "stderr"):
            assert getattr(one, name).tobytes() == getattr(many, name)[place].tobytes()
        assert (one.fun, one.mse2, one.status) == (many.fun[place], many.mse2[place], many.status[place])
        assert len(one.minima) == many.minima[place]
        for name, column in many.table.items():
            assert np.array_equal(column[place], np.array(one.table[name], column.dtype), equal_nan=True), name
        assert (one.table["mse2"], one.table["m"]) == (one.mse2, one.x[3])
        assert one.table["stop"] in ("cost", "step")
        assert one.table["terms"] == ["diffuse", "surface", "volume", "absorbing"]
    # Angles of their own for each scan, Fortran order, steps and a single thread change no number.
    angles = np.asfortranarray(np.broadcast_to(theta_s, measured.shape))
    other = brdfit.fit_many(np.full((2, 1, 1), 30), angles[..., ::-1], measured[..., ::-1], threads=1)
    assert other.success.all()
    other = brdfit.fit_many(np.full((2, 1, 1), 30), angles, measured, threads=1)
    assert pickle.dumps(other) == pickle.dumps(many)
    assert many.parameters["m"].tolist() == many.x[..., 3].tolist()


def test_an_empty_cube_has_an_empty_result():
    assert brdfit.fit_many(30, np.arange(10.0), np.ones((0, 10))).x.shape == (0, 6)


def test_invalid_samples_are_left_out(cube):
    theta_s, measured = cube
    measured = measured.copy()
    measured[0, 1, 5:9] = np.nan, 0, -1, np.inf
    measured[1, 2, 5:] = np.nan
    with pytest.raises(ValueError, match=r"^scan 1: brdf\[5\] is NaN"):
        brdfit.fit_many(30, theta_s, measured)
    many = brdfit.fit_many(30, theta_s, measured, drop_invalid=True)
    kept = np.r_[0:5, 9:60]
    assert many.x[0, 1].tolist() == brdfit.fit(30, theta_s[kept], measured[0, 1, kept]).x.tolist()
    assert many.success.tolist() == [[True] * 3, [True, True, False]]
    assert np.isnan(many.x[1, 2]).all() and many.status[1, 2] == 4
    assert "fewer valid samples than parameters" in repr(many)
    one = brdfit.fit(30, theta_s, measured[0, 1], drop_invalid=True)
    assert one.samples == 56 and one.x.tolist() == many.x[0, 1].tolist()


def test_the_interpreter_runs_on_while_scans_are_fitted(cube):
    theta_s, measured = cube
    scans = np.resize(measured, (300, 60))
    begins = threading.Event()

    def work():
        begins.set()
        brdfit.fit_many(30, theta_s, scans, threads=1)

    worker = threading.Thread(target=work)
    worker.start()
    begins.wait()
    turns = 0
    while worker.is_alive():
        worker.join(0.001)
        turns += 1
    # With the lock held this loop would wait for the whole call in its first turn or two.
    assert turns > 5


def test_a_forked_process_fits_too(cube):
    theta_s, measured = cube
    here = brdfit.fit_many(30, theta_s, measured[0])
    with multiprocessing.get_context("fork").Pool(1) as pool:
        there = pool.apply_async(brdfit.fit_many, (30, theta_s, measured[0])).get(timeout=120)
    assert pickle.dumps(there) == pickle.dumps(here)


ANGLES, VALUES = np.arange(10.0), np.ones(10)
TERM_SETS = r"terms takes one of: diffuse \| diffuse,surface \|"


@pytest.mark.parametrize(
    "arguments, keywords, message",
    [
        ((30, ANGLES, -VALUES), {}, r"^brdf\[0\] is -1, which has no logarithm; leave the sample out"),
        ((30, ANGLES, VALUES * 1e-310), {}, r"^brdf\[0\] is 1e-310, which is not a number to compute with; "),
        ((-30, ANGLES, VALUES), {}, r"^theta_i\[0\] is -30, .*; take degrees, 0 <= theta_i < 90"),
        ((30, ANGLES * 10, VALUES), {}, r"^theta_s\[9\] is 90, "),
        ((30, ANGLES, VALUES), {"delta_phi": np.nan}, r"^delta_phi\[0\] is NaN, "),
        ((30, ANGLES, VALUES), {"sigma": 0}, r"^sigma\[0\] is 0, which is not a standard deviation; "),
        ((30, ANGLES, VALUES), {"sigma": np.inf}, r"^sigma\[0\] is inf, which is not a standard deviation; "),
        ((30, ANGLES, -VALUES), {"sigma": 1}, r"^brdf\[0\] is -1, which has no logarithm; "),
        (
            (30, ANGLES[:5], VALUES[:5]),
            {},
            "^scan: 5 samples cannot determine 6 parameters; measure more, or take fewer terms$",
        ),
        ((30, ANGLES, VALUES[:5]), {}, r"^the shapes do not broadcast: theta_i \(\), theta_s \(10,\), .*brdf \(5,\)$"),
        ((30, ANGLES, 1.0), {}, r"^brdf has the shape \(\), the others ask for \(10,\); give one BRDF a sample$"),
        ((30, ANGLES, [VALUES]), {}, r"^brdf has the shape \(1, 10\); this takes one scan, fit_many several$"),
        ((30, ANGLES, ["a"] * 10), {}, "^brdf is not an array of numbers: "),
        ((30, ANGLES, VALUES), {"terms": "shiny"}, f"^there is no term 'shiny'; {TERM_SETS}"),
        ((30, ANGLES, VALUES), {"terms": ["volume"]}, f"^there is no model of just the terms volume; {TERM_SETS}"),
        (
            (30, ANGLES, VALUES),
            {"bounds": {"m": (2, 1)}},
            r"^the bounds of m are the wrong way round; write 'm': \(1, 2\)$",
        ),
        ((30, ANGLES, VALUES), {"bounds": {"n": 0.5}}, "^n cannot be 0.5; take a number from 1 to 1000000$"),
        ((30, ANGLES, VALUES), {"bounds": {"n": np.nan}}, "^n cannot be NaN; "),
        ((30, ANGLES, VALUES), {"bounds": {"n": (1, 2, 3)}}, r"^bounds\['n'\] is \(1, 2, 3\); give \(least, largest\)"),
        ((30, ANGLES, VALUES), {"bounds": {"q": 1}}, "^there is no parameter 'q'; the parameters are rho_d, "),
        ((30, ANGLES, VALUES), {"bounds": {"m": 1}, "terms": "diffuse"}, "^m is not a parameter of the terms diffuse; "),
        ((30, ANGLES, VALUES), {"method": "best"}, r"^invalid value 'best' for method \[possible values: default, paper\]$"),
        ((30, ANGLES, VALUES), {"seed": -1}, "^seed is -1; take a whole number from 0 "),
        ((30, ANGLES, VALUES), {"seed": 2**64}, "^seed is 18446744073709551616; "),
        ((30, ANGLES, VALUES), {"threads": 10**9}, "^threads is 1000000000; take a whole number from 1 to 1024$"),
        ((30, ANGLES, VALUES), {"model": "phong"}, "^there is no model 'phong'; the models are beckmann, "),
        ((30, ANGLES, VALUES * 1j), {}, "^brdf is not an array of numbers: its type is complex128; "),
        ((30, ANGLES, VALUES.astype(object)), {}, "^brdf is not an array of numbers: its type is object; "),
        ((30, ANGLES, VALUES > 0), {}, "^brdf is not an array of numbers: its type is bool; "),
        ((30, ANGLES, VALUES.astype("M8[s]")), {}, r"^brdf is not an array of numbers: its type is datetime64\[s\]; "),
        ((30, [], []), {}, "^brdf has no samples$"),
        ((30, ANGLES, VALUES), {"mask": VALUES > 0}, "^all samples are left out$"),
        ((30, ANGLES, VALUES), {"mask": VALUES}, "^mask has the type float64; give True where "),
        ((30, ANGLES, VALUES), {"mask": np.ma.masked_array(VALUES < 0, mask=VALUES > 0)}, "^mask is masked itself; "),
        ((30, ANGLES, VALUES), {"robust": "yes"}, "^robust is 'yes'; take True or False$"),
        ((30, ANGLES, VALUES), {"drop_invalid": "no"}, "^drop_invalid is 'no'; take True or False$"),
        ((30, ANGLES, VALUES), {"prior": {"n": 1.5}}, r"^prior\['n'\] is 1.5; give \(value, standard error\)$"),
        ((30, ANGLES, VALUES), {"prior": ("n", 1)}, r"^prior is not a mapping; write prior=\{'?\"n\": \(1.5, 0.02\)\}$"),
        ((30, ANGLES, VALUES), {"certify": "1%"}, "^certify is '1%'; take a part above 0 and below 1, such as 0.05$"),
        ((30, ANGLES, VALUES), {"certify": 0.1, "proof_boxes": 1.5}, "^proof_boxes is 1.5; take a whole number from 1 "),
        ((30, ANGLES, VALUES), {"certify": 0.1, "proof_seconds": "a"}, "^proof_seconds is 'a'; take a number above 0$"),
        ((30, ANGLES, VALUES), {"proof_boxes": 9}, "^proof_boxes is what a proof may take; give certify too"),
    ],
)
def test_bad_input_is_one_clear_line(arguments, keywords, message):
    with pytest.raises(ValueError, match=message) as caught:
        brdfit.fit(*arguments, **keywords)
    assert "\n" not in str(caught.value)


def test_options_in_the_words_of_python():
    plain = brdfit.fit(30, ANGLES, VALUES)
    assert brdfit.fit(30, ANGLES, VALUES, robust=np.False_, drop_invalid=np.True_).x.tobytes() == plain.x.tobytes()
    pair = brdfit.fit(30, ANGLES, VALUES, prior={"n": (1.5, 0.02)}, robust=np.True_)
    text = brdfit.fit(30, ANGLES, VALUES, prior={"n": "1.5+-0.02"}, robust=True)
    assert pair.x.tobytes() == text.x.tobytes() and pair.json == text.json


def test_bad_input_of_many():
    with pytest.raises(ValueError, match=r"^each\[0\] is None; give keywords of the search, "):
        brdfit.fit_many(30, ANGLES, [VALUES], each=[None])
    with pytest.raises(ValueError, match=r"^brdf has the shape \(10,\); fit_many takes \(scans, samples\)"):
        brdfit.fit_many(30, ANGLES, VALUES)
    with pytest.raises(ValueError, match="^threads is 0; "):
        brdfit.fit_many(30, ANGLES, [VALUES], threads=0)
    with pytest.raises(ValueError, match="^5 samples cannot determine 6 parameters; "):
        brdfit.fit_many(30, ANGLES[:5], [VALUES[:5]])
