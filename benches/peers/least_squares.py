"""SciPy's least_squares on the handed-over sets: prints set,seconds,evaluations,sum of squares for each start."""

import pathlib
import sys
import time

import numpy as np
from scipy.optimize import least_squares

LOWER = np.array([0.0, 0.0, 0.0, 1e-5, 1.0, 0.0])
UPPER = np.array([1.0, 100.0, 100.0, 10.0, 100.0, 100.0])
# SciPy's method is slower with all starts than is worth waiting for.
STARTS = 100

folder = pathlib.Path(sys.argv[1])


def fresnel(n, kappa, c):
    """Unpolarised F in real arithmetic, so that complex steps differentiate it."""
    s2 = 1 - c * c
    alpha = n * n - kappa * kappa - s2
    q = np.sqrt(alpha * alpha + 4 * n * n * kappa * kappa)
    a = np.sqrt(0.5 * (q + alpha))
    b = n * kappa / a
    rs = ((a - c) ** 2 + b * b) / ((a + c) ** 2 + b * b)
    t = ((a * c - s2) ** 2 + (b * c) ** 2) / ((a * c + s2) ** 2 + (b * c) ** 2)
    return 0.5 * rs * (1 + t)


def model(x, rows):
    """ln f less the measured; x may have a further axis of points."""
    rho_d, rho_s, rho_v, m, n, kappa = x[..., None]
    f = rho_d / np.pi
    for rho, tan2, c, factor in ((rho_s, *rows[1:4]), (rho_v, *rows[4:7])):
        f = f + rho * fresnel(n, kappa, c) * factor * np.exp(-tan2 / (m * m)) / (m * m)
    return np.log(f + 1e-300) - rows[0]


np.seterr(all="ignore")
starts = np.loadtxt(folder / "starts.txt")[:STARTS]
for k in range(3):
    rows = np.loadtxt(folder / f"set{k}.txt").T
    evaluations = 0

    def residuals(x):
        global evaluations
        evaluations += 1
        return np.clip(np.nan_to_num(model(x, rows), nan=1e6), -1e6, 1e6)

    def jacobian(x):
        global evaluations
        evaluations += 1
        points = x[:, None] + 1e-100j * np.eye(6)
        return np.clip(np.nan_to_num(model(points, rows).imag.T * 1e100), -1e9, 1e9)

    for start in starts:
        evaluations, begun = 0, time.process_time()
        fit = least_squares(residuals, start, jac=jacobian, bounds=(LOWER, UPPER), x_scale="jac")
        print(f"{k},{time.process_time() - begun},{evaluations},{2 * fit.cost}")
