"""Ctrl-C ends everything within 0.2 s of computing."""

import os
import signal
import subprocess
import sys
import time

import pytest

from common import DATA

# Each takes minutes if it is let.
LONG = {
    "fit": "brdfit.fit(scan, method='paper', starts=1_000_000)",
    "fit of the default method": "brdfit.fit(scan, starts=1_000_000)",
    "errors of a long scan": "brdfit.fit(45, dense, wandering, terms='diffuse')",
    "fit with every model": "brdfit.fit(scan, model='auto', terms='auto', method='paper', starts=1_000_000)",
    "a long scan, with every model": "brdfit.fit(45, dense, wandering, model='auto')",
    "robust": "brdfit.fit(scan, robust=True, method='paper', starts=1_000_000)",
    "fit_many": "brdfit.fit_many(45, np.arange(-80.0, 80.0), many)",
    "certify": "brdfit.fit(scan, certify=1e-9)",
    "brdf": "brdfit.brdf(45, angles, [0.1, 1, 1, 0.1, 1.5, 0])",
    "profile": "brdfit.profile(scan, bootstrap=1_000_000)",
    "calibrate": "brdfit.profile(scan, calibrate=1_000_000)",
    "joint": "brdfit.joint([scan] * 8, starts=100_000)",
    "aperture": "brdfit.fit(45, dense, wandering, aperture_half_angle=2)",
    "a long scan, profiled": "brdfit.profile(brdfit.scan(45, dense, wandering))",
    "table": "[brdfit.scan(45, dense, wandering).table() for _ in range(9)]",
    "report": "brdfit.report(scan, method='paper', starts=1_000_000)",
}
SCRIPT = f"""
import os, sys, time
import numpy as np
import brdfit
scan = brdfit.read({str(DATA / "testdata1_sym_seed1.csv")!r})[0]
many = np.random.default_rng(0).uniform(1, 2, (100_000, 160))
angles = np.zeros(50_000_000)
dense = np.linspace(-80, 80, 1_000_000)
wandering = 0.1 + 0.01 * np.sin(dense)
print("ready", flush=True)
try:
    {{}}
    print("it ended before")
except KeyboardInterrupt:
    begun = float(sys.stdin.readline())
    # Computing still goes on if this process uses time.
    used = time.process_time()
    print(time.monotonic() - begun, flush=True)
    time.sleep(1.5)
    print(time.process_time() - used, flush=True)
"""


@pytest.mark.parametrize("what", LONG)
def test_an_interrupt_ends_it(what):
    process = subprocess.Popen(
        [sys.executable, "-c", SCRIPT.format(LONG[what])], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
    )
    assert process.stdout.readline() == "ready\n"
    time.sleep(1)
    begun = time.monotonic()
    os.kill(process.pid, signal.SIGINT)
    output, _ = process.communicate(f"{begun}\n", timeout=60)
    waited, used = map(float, output.split())
    # 0.2 s where the machine is idle; what it waits for a processor is the machine's.
    print(f"{what}: {waited:.3f} s, and {used:.3f} s of computing")
    assert waited < 5, f"{what}: {waited} s"
    assert used < 0.2, f"{what}: {used} s of computing afterwards"
