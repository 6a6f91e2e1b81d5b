"""A cube on a Dask cluster of three processes: nothing is lost with what is killed, and no bit differs from the plain loop."""

import subprocess
import sys
import time
from contextlib import contextmanager
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

import brdfit

EXAMPLES = Path(__file__).resolve().parents[1] / "examples"
sys.path.insert(0, str(EXAMPLES))

import dask_cube  # noqa: E402

PIXELS, CHUNK = 64, 2
CHUNKS = PIXELS // CHUNK


@contextmanager
def processes():
    """Starts processes; those that still run are killed at the end."""
    started = []

    def start(*command):
        started.append(subprocess.Popen([sys.executable, *map(str, command)]))
        return started[-1]

    try:
        yield start
    finally:
        for process in started:
            process.kill()
            process.wait()


def stored(result):
    """The chunks that are stored, each with its file's identity and time of writing."""
    files = {path: path.stat() for path in (result / "fit" / "c").glob("*/0/0")}
    return {path: (about.st_ino, about.st_mtime_ns) for path, about in files.items()}


def wait_for(condition, process):
    """Waits until the condition holds; the process must not end before."""
    while not condition():
        assert process.poll() is None, "it ended before it could be killed"
        time.sleep(0.002)


@pytest.fixture(scope="module")
def cube(tmp_path_factory):
    path = tmp_path_factory.mktemp("dask") / "cube.zarr"
    dask_cube.make(path, pixels=PIXELS, wavelengths=8, samples=40, chunk=CHUNK)
    return path


def test_killed_in_mid_job(cube):
    result, scheduler = cube.parent / "fits.zarr", cube.parent / "scheduler.json"
    with processes() as start:
        start(
            *("-m", "distributed.cli.dask_scheduler", "--scheduler-file", scheduler),
            *("--host", "127.0.0.1", "--port", 0, "--dashboard-address", "127.0.0.1:0"),
        )
        worker = (
            *("-m", "distributed.cli.dask_worker", "--scheduler-file", scheduler, "--nthreads", 1, "--no-nanny"),
            *("--no-dashboard", "--local-directory", cube.parent),
        )
        workers = [start(*worker), start(*worker)]
        wait_for(scheduler.exists, workers[0])
        job = (EXAMPLES / "dask_cube.py", "fit", cube, result, "--scheduler", scheduler)

        # The client dies, and with it the job; what is stored stays.
        client = start(*job)
        wait_for(lambda: len(stored(result)) > 2, client)
        client.kill()
        client.wait()
        first = stored(result)
        assert len(first) < CHUNKS

        # A worker dies in the run that continues; its chunks go to the other.
        client = start(*job)
        wait_for(lambda: len(stored(result)) > len(first) + 2, client)
        workers[0].kill()
        workers[0].wait()
        assert len(stored(result)) < CHUNKS
        assert client.wait() == 0
        last = stored(result)

        # A third run has nothing to do.
        assert start(*job).wait() == 0
        assert stored(result) == last
    assert len(last) == CHUNKS
    assert first.items() <= last.items()

    brdf = xr.open_zarr(cube, consolidated=False)
    loop = [
        [(*(one := brdfit.fit(45, brdf.theta_s.values, scan)).x, one.mse2, one.status) for scan in pixel]
        for pixel in brdf.brdf.values
    ]
    assert xr.open_zarr(result, consolidated=False).fit.values.tobytes() == np.array(loop, float).tobytes()
