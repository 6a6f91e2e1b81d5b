"""Fits a cube of pixel x wavelength x sample on a Dask cluster; a re-run continues from what is stored.

    python dask_cube.py make cube.zarr
    python dask_cube.py fit cube.zarr fits.zarr --scheduler scheduler.json

The cube is a Zarr store with the BRDF in sr^-1 and the angles in degrees.
Its chunks are the tasks: a chunk of the result is written as one object, so it is there whole or not at all, and a worker or a client that dies loses only the chunks in its hands.
"""

import argparse
import os

import numpy as np
import xarray as xr
from distributed import Client, as_completed

import brdfit

VALUES = (*brdfit.NAMES, "mse2", "status")


def make(path, pixels, wavelengths, samples, chunk):
    """Writes a synthetic cube: materials that vary from pixel to pixel, an index of refraction that varies with wavelength, noise of +-5 %."""
    random = np.random.default_rng(0)
    theta_s = np.linspace(-80, 80, samples)
    wavelength = np.linspace(400, 1000, wavelengths)
    rho_d, rho_s, m = random.uniform([[0.01], [1], [0.05]], [[0.1], [20], [0.3]], (3, pixels))
    n = np.linspace(3, 1.3, wavelengths)
    x = np.stack(np.broadcast_arrays(rho_d[:, None], rho_s[:, None], 0, m[:, None], n, 0.5), axis=-1)
    brdf = brdfit.brdf(45, theta_s, x[:, :, None, :]) * random.uniform(0.95, 1.05, (pixels, wavelengths, samples))
    cube = xr.Dataset(
        {"brdf": (("pixel", "wavelength", "sample"), brdf, {"units": "sr^-1"})},
        {"theta_s": ("sample", theta_s, {"units": "deg"}), "wavelength": ("wavelength", wavelength, {"units": "nm"})},
        {"theta_i_deg": 45.0},
    )
    cube.chunk(pixel=chunk).to_zarr(path, mode="w", consolidated=False)


def fit_chunk(brdf, theta_s, theta_i):
    """The fits of an array of shape (..., sample), as one of shape (..., value); one thread, for Dask runs a task on each core."""
    fits = brdfit.fit_many(theta_i, theta_s, brdf, threads=1)
    return np.concatenate([fits.x, fits.mse2[..., None], fits.status[..., None]], axis=-1)


def fits_of(cube):
    """The fits of a cube, not yet computed."""
    return xr.apply_ufunc(
        fit_chunk,
        cube.brdf,
        cube.theta_s.drop_vars("theta_s"),
        input_core_dims=[["sample"], ["sample"]],
        output_core_dims=[["value"]],
        kwargs={"theta_i": cube.theta_i_deg},
        dask="parallelized",
        dask_gufunc_kwargs={"output_sizes": {"value": len(VALUES)}},
        output_dtypes=[np.float64],
    ).assign_attrs(values=VALUES)


def fit(client, cube_path, result_path):
    """Fits what `result_path` does not hold yet, on a Dask cluster; returns how many chunks that were, and of how many."""
    fits = fits_of(xr.open_zarr(cube_path, consolidated=False)).to_dataset(name="fit")
    if not os.path.exists(result_path):
        # Writes what describes the array, and no chunk of it; renamed, so that it is there whole.
        fits.to_zarr(f"{result_path}.new", mode="w", compute=False, consolidated=False)
        os.rename(f"{result_path}.new", result_path)
    # What is not stored reads as NaN, and no status is NaN.
    status = xr.open_zarr(result_path, consolidated=False).fit.isel(value=VALUES.index("status"), wavelength=0)
    stored = status.notnull().compute().values
    ends = np.cumsum(fits.chunks["pixel"])
    missing = [slice(int(end - size), int(end)) for end, size in zip(ends, fits.chunks["pixel"]) if not stored[end - 1]]
    # A region that is written may hold no coordinate that does not lie in it.
    plain = fits.drop_vars("wavelength")
    into = {"compute": False, "consolidated": False}
    writes = [plain.isel(pixel=part).to_zarr(result_path, region={"pixel": part}, **into) for part in missing]
    # Each is forgotten when it is done: what is stored must not be computed again when its worker dies later.
    for written in as_completed(client.compute(writes)):
        written.result()
    return len(missing), len(ends)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    commands = parser.add_subparsers(dest="command", required=True)
    making = commands.add_parser("make", help="writes a synthetic cube")
    making.add_argument("cube")
    for name, value in {"pixels": 256, "wavelengths": 16, "samples": 171, "chunk": 16}.items():
        making.add_argument(f"--{name}", type=int, default=value, help=f"default {value}")
    fitting = commands.add_parser("fit", help="fits a cube, or what is not stored of it yet")
    fitting.add_argument("cube")
    fitting.add_argument("result")
    fitting.add_argument(
        "--scheduler", metavar="FILE", help="its --scheduler-file; by default two workers on this machine"
    )
    arguments = parser.parse_args()
    if arguments.command == "make":
        make(arguments.cube, arguments.pixels, arguments.wavelengths, arguments.samples, arguments.chunk)
        return
    cluster = (
        {"scheduler_file": arguments.scheduler} if arguments.scheduler else {"n_workers": 2, "threads_per_worker": 1}
    )
    with Client(**cluster) as client:
        done, chunks = fit(client, arguments.cube, arguments.result)
    print(f"fitted {done} of {chunks} chunks, the others were stored")


if __name__ == "__main__":
    main()
