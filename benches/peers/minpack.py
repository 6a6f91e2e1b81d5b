"""NIST's nonlinear regression sets by MINPACK (scipy.optimize.leastsq): prints set,start,LRE,evaluations,stop."""

import pathlib
import warnings

import numpy as np
from numpy import arctan, cos, exp, log, pi, sin
from scipy.optimize import leastsq

FOLDER = pathlib.Path(__file__).parents[2] / "tests/data/nist"


def gauss(x, b):
    return b[0] * exp(-b[1] * x) + b[2] * exp(-(((x - b[3]) / b[4]) ** 2)) + b[5] * exp(-(((x - b[6]) / b[7]) ** 2))


def lanczos(x, b):
    return b[0] * exp(-b[1] * x) + b[2] * exp(-b[3] * x) + b[4] * exp(-b[5] * x)


def cubic(x, b):
    return (b[0] + (b[1] + (b[2] + b[3] * x) * x) * x) / (1 + (b[4] + (b[5] + b[6] * x) * x) * x)


def enso(x, b):
    turn = 2 * pi * x
    return (b[0] + b[1] * cos(turn / 12) + b[2] * sin(turn / 12) + b[4] * cos(turn / b[3]) + b[5] * sin(turn / b[3])
            + b[7] * cos(turn / b[6]) + b[8] * sin(turn / b[6]))


MODELS = {
    "Misra1a": lambda x, b: b[0] * (1 - exp(-b[1] * x)),
    "Chwirut2": lambda x, b: exp(-b[0] * x) / (b[1] + b[2] * x),
    "Chwirut1": lambda x, b: exp(-b[0] * x) / (b[1] + b[2] * x),
    "Lanczos3": lanczos,
    "Gauss1": gauss,
    "Gauss2": gauss,
    "DanWood": lambda x, b: b[0] * x ** b[1],
    "Misra1b": lambda x, b: b[0] * (1 - (1 + b[1] * x / 2) ** -2),
    "Kirby2": lambda x, b: (b[0] + (b[1] + b[2] * x) * x) / (1 + (b[3] + b[4] * x) * x),
    "Hahn1": cubic,
    "Nelson": lambda x, b: b[0] - b[1] * x[0] * exp(-b[2] * x[1]),
    "MGH17": lambda x, b: b[0] + b[1] * exp(-b[3] * x) + b[2] * exp(-b[4] * x),
    "Lanczos1": lanczos,
    "Lanczos2": lanczos,
    "Gauss3": gauss,
    "Misra1c": lambda x, b: b[0] * (1 - (1 + 2 * b[1] * x) ** -0.5),
    "Misra1d": lambda x, b: b[0] * b[1] * x / (1 + b[1] * x),
    "Roszman1": lambda x, b: b[0] - b[1] * x - arctan(b[2] / (x - b[3])) / pi,
    "ENSO": enso,
    "MGH09": lambda x, b: b[0] * (x * x + x * b[1]) / (x * x + x * b[2] + b[3]),
    "Thurber": cubic,
    "BoxBOD": lambda x, b: b[0] * (1 - exp(-b[1] * x)),
    "Rat42": lambda x, b: b[0] / (1 + exp(b[1] - b[2] * x)),
    "MGH10": lambda x, b: b[0] * exp(b[1] / (x + b[2])),
    "Eckerle4": lambda x, b: b[0] / b[1] * exp(-0.5 * ((x - b[2]) / b[1]) ** 2),
    "Rat43": lambda x, b: b[0] / (1 + exp(b[1] - b[2] * x)) ** (1 / b[3]),
    "Bennett5": lambda x, b: b[0] * (b[1] + x) ** (-1 / b[2]),
}


def run(name, model):
    lines = (FOLDER / f"{name}.dat").read_text().splitlines()
    rows = [line.split("=")[1].split() for line in lines[40:60] if "=" in line and line.strip().startswith("b")]
    starts = np.array([[float(cell) for cell in row[:2]] for row in rows]).T
    certified = np.array([float(row[2]) for row in rows])
    data = np.array([[float(cell) for cell in line.split()] for line in lines[60:] if line.strip()])
    y, x = data[:, 0], data[:, 1:].T
    y, x = (np.log(y), x) if name == "Nelson" else (y, x[0])

    def jacobian(b):
        # A step along the imaginary axis has no difference to lose digits in.
        step = 1e-100 * 1j
        columns = [model(x, b + step * unit).imag / 1e-100 for unit in np.eye(len(b))]
        return np.array([np.broadcast_to(column, y.shape) for column in columns]).T

    for k, start in enumerate(starts):
        got, _, info, _, stop = leastsq(
            lambda b: model(x, b) - y, start, Dfun=jacobian, full_output=True,
            ftol=1e-15, xtol=1e-15, gtol=0.0, maxfev=10_000,
        )
        error = np.max(np.abs(got / certified - 1))
        digits = min(11.0, -np.log10(error)) if error > 0 else 11.0
        stops = {1: "ftol", 2: "xtol", 3: "ftol", 4: "gtol", 5: "evaluations", 6: "no better (ftol)",
                 7: "no better (xtol)", 8: "no better (gtol)"}
        print(f"{name},{k + 1},{digits},{info['nfev']},{stops.get(stop, stop)}")


warnings.simplefilter("ignore")
np.seterr(all="ignore")
for name, model in MODELS.items():
    run(name, model)
