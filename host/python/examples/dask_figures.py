"""Measures what a Dask cluster on this machine costs and gains over a plain loop, and prints it as a table.

python dask_figures.py
"""

import argparse
import tempfile
import time
from pathlib import Path

import xarray as xr
from distributed import Client

import brdfit
import dask_cube

WAVELENGTHS, SAMPLES = 16, 171


def peak_memory():
    """The most memory that this process has had in RAM, in MB."""
    lines = Path("/proc/self/status").read_text().splitlines()
    return next(int(line.split()[1]) for line in lines if line.startswith("VmHWM")) / 1024


def seconds(work):
    begun = time.perf_counter()
    work()
    return time.perf_counter() - begun


def cluster(workers, cube, folder, repeats):
    """Least time of a job on so many workers, with their peak memory before and after, in MB."""
    with Client(n_workers=workers, threads_per_worker=1, dashboard_address=None) as client:
        # What is only imported, compiled and connected once is not counted.
        small = folder / "small.zarr"
        dask_cube.make(small, workers, 2, SAMPLES, chunk=1)
        dask_cube.fit(client, small, folder / f"warm{workers}.zarr")
        before = max(client.run(peak_memory).values())
        paths = (folder / f"fits{workers}_{repeat}.zarr" for repeat in range(repeats))
        least = min(seconds(lambda path=path: dask_cube.fit(client, cube, path)) for path in paths)
        return least, before, max(client.run(peak_memory).values())


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument(
        "--pixels", type=int, default=256, help=f"of the cube, with {WAVELENGTHS} wavelengths each; default 256"
    )
    parser.add_argument("--chunk", type=int, default=16, help="pixels of a chunk; default 16")
    parser.add_argument(
        "--repeats", type=int, default=3, help="of each measurement, of which the least counts; default 3"
    )
    arguments = parser.parse_args()
    count = arguments.pixels * WAVELENGTHS
    chunks = -(-arguments.pixels // arguments.chunk)
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        path = folder / "cube.zarr"
        dask_cube.make(path, arguments.pixels, WAVELENGTHS, SAMPLES, arguments.chunk)
        cube = xr.open_zarr(path, consolidated=False)
        theta_s, brdf = cube.theta_s.values, cube.brdf.values
        scans = brdf.reshape(-1, SAMPLES)
        repeats = range(arguments.repeats)
        loop = min(seconds(lambda: [brdfit.fit(45, theta_s, scan) for scan in scans]) for _ in repeats)
        many = min(seconds(lambda: brdfit.fit_many(45, theta_s, scans, threads=1)) for _ in repeats)
        one, *_ = cluster(1, path, folder, arguments.repeats)
        two, before, after = cluster(2, path, folder, arguments.repeats)
        serial = dask_cube.fit_chunk(brdf, theta_s, 45.0)
        for result in sorted(folder.glob("fits*.zarr")):
            assert xr.open_zarr(result, consolidated=False).fit.values.tobytes() == serial.tobytes()

    fits = f"{count} fits of {SAMPLES} samples, {chunks} chunks"
    print(f"| {fits} | time, s | a fit, ms | over the plain loop, us a fit |")
    print("|---|--:|--:|--:|")
    rows = {"loop over `fit`": loop, "`fit_many`, 1 thread": many, "Dask, 1 worker": one, "Dask, 2 workers": two}
    for title, spent in rows.items():
        print(f"| {title} | {spent:.2f} | {spent / count * 1e3:.3f} | {(spent - loop) / count * 1e6:+.0f} |")
    print()
    print(f"Efficiency of 2 workers: {loop / (2 * two):.3f} of the plain loop, {one / (2 * two):.3f} of 1 worker.")
    print(f"Overhead: {(one - many) / chunks * 1e3:.1f} ms a chunk with 1 worker.")
    print(f"Memory of a worker at its most: {before:.0f} MB before the job, {after:.0f} MB after it.")
    print("All results have the bits of the plain loop.")
    print()
    fits, cores, size = 1e9, 1000, 4000
    hours = fits * loop / count / 3600
    overhead = (one - many) / chunks
    print(f"10^9 such fits: {hours:.0f} core hours, {hours / cores * 60:.0f} min on {cores} cores.")
    print(f"They read {fits * SAMPLES * 8 / 1e12:.2f} TB and write {fits * len(dask_cube.VALUES) * 8 / 1e9:.0f} GB.")
    print(
        f"In chunks of {size} fits that is {fits / size:.0f} chunks of {size * SAMPLES * 8 / 1e6:.1f} MB and {size * loop / count:.1f} s each;"
        f" at {overhead * 1e3:.1f} ms a chunk, one client and scheduler are busy for {fits / size * overhead / 60:.0f} min."
    )


if __name__ == "__main__":
    main()
