"""The model from Python: the program's numbers, shapes, and what is said of bad input."""

import numpy as np
import pytest

import brdfit

from common import program

PARAMETERS = {"rho_d": 0.1, "rho_s": 10.0, "rho_v": 0.02, "m": 0.1, "n": 3.0, "kappa": 1.0}


@pytest.mark.parametrize("ln", [False, True])
def test_the_bits_of_the_program(ln):
    options = [text for name, value in PARAMETERS.items() for text in (f"--{name.replace('_', '-')}", value)]
    angles = ["--theta-i", "0,45,80", "--theta-s", "-85:85:5", "--delta-phi", "180,90,0.5"]
    table = program("simulate", *angles, *options, *(["--ln"] if ln else []))
    theta_i, theta_s, delta_phi, expected = np.loadtxt(table.splitlines(), delimiter=",", skiprows=1).T
    value = brdfit.brdf(theta_i, theta_s, PARAMETERS, delta_phi=delta_phi, ln=ln)
    assert value.tolist() == expected.tolist()


def test_shapes():
    x = np.array(list(PARAMETERS.values()))
    scales = np.ones((2, 1, 6))
    scales[1, 0, :3] = 0.5
    values = brdfit.brdf(30, [-60.0, 0, 30, 60], x * scales)
    assert values.shape == (2, 4)
    halves = {name: value / 2 if name.startswith("rho") else value for name, value in PARAMETERS.items()}
    assert values[1].tolist() == brdfit.brdf(30, [-60, 0, 30, 60], halves).tolist()
    assert values[0, 2] == brdfit.brdf(30, 30, PARAMETERS) and brdfit.brdf(30, 30, x).shape == ()


def test_absent_terms_and_underflow():
    assert brdfit.brdf(30, [-60, 30], {"rho_d": 0.5}).tolist() == [brdfit.brdf(0, 0, [0.5, 0, 0, 1, 1, 0])] * 2
    needle = {"rho_s": 1, "m": 0.005, "n": 1.5}
    assert brdfit.brdf(30, -30, needle) == 0 and -1e5 < brdfit.brdf(30, -30, needle, ln=True) < -1e3
    assert np.isnan(brdfit.brdf(30, 30, [np.nan] * 6))


@pytest.mark.parametrize(
    "arguments, message",
    [
        ((30, [0, 95], PARAMETERS), "^the angle is at or beyond the horizon at theta_i = 30, theta_s = 95 degrees; "),
        ((-1, 0, PARAMETERS), "^the angle is at or beyond the horizon at theta_i = -1, .*take 0 <= theta_i < 90"),
        ((30, 0, {"sigma": 1}), "^there is no parameter 'sigma'; the parameters are rho_d, "),
        ((30, 0, {"n": 0.9}), "^n cannot be 0.9; take a number from 1 to 1000000$"),
        ((30, 0, [1, 2, 3]), r"^parameters has the shape \(3,\); its last axis takes the 6 of NAMES$"),
        ((30, [0, 1], np.ones((3, 6))), r"^the shapes do not broadcast: .*theta_s \(2,\), .*parameters \(3,\)$"),
    ],
)
def test_bad_input_is_one_clear_line(arguments, message):
    with pytest.raises(ValueError, match=message):
        brdfit.brdf(*arguments)
