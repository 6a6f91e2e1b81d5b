"""What the tests share."""

import subprocess
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[3]
DATA = ROOT / "tests" / "data"


def program(*arguments):
    """Standard output of the program `brdfit`."""
    command = ["cargo", "run", "--quiet", "--release", "--", *map(str, arguments)]
    return subprocess.run(command, cwd=ROOT, check=True, stdout=subprocess.PIPE, text=True).stdout


def scan(name):
    """theta_i, theta_s in degrees and BRDF of one of the project's scans."""
    return np.loadtxt(DATA / name, delimiter=",", skiprows=1).T
