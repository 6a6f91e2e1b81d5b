"""What the tests share."""

import subprocess
import sys
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[3]
DATA = ROOT / "tests" / "data"


def program(*arguments):
    """Standard output of the program `brdfit`, as the package brings it."""
    command = [sys.executable, "-m", "brdfit", *map(str, arguments)]
    return subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True).stdout


def scan(name):
    """theta_i, theta_s in degrees and BRDF of one of the project's scans."""
    return np.loadtxt(DATA / name, delimiter=",", skiprows=1).T
