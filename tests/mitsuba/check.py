#!/usr/bin/env python3
"""Checks the Mitsuba exports against brdfit at 1000 pairs of directions, the densities against quadrature, and renders a sphere.

pip install mitsuba==3.9.1 numpy
tests/mitsuba/check.py target/release/brdfit [sphere.png]
"""
import importlib.util
import pathlib
import subprocess
import sys
import tempfile

import drjit as dr
import mitsuba as mi
import numpy as np

mi.set_variant("llvm_ad_rgb")
program, picture = sys.argv[1], (sys.argv[2:] + [None])[0]
PARAMETERS = {"rho_d": 0.1, "rho_s": 10.0, "rho_v": 0.01, "m": 0.1, "n": 3.0, "kappa": 1.0}  # test data 1 of the paper
folder = pathlib.Path(tempfile.mkdtemp())


def brdfit(*arguments):
    return subprocess.run([program, *arguments], check=True, capture_output=True, text=True).stdout


def module(form, name, **changes):
    parameters = ",".join(f"{key}={value}" for key, value in {**PARAMETERS, **changes}.items())
    path = folder / f"{name}.py"
    brdfit("export", "--params", parameters, "--to", form, "--name", name, "--output", str(path))
    spec = importlib.util.spec_from_file_location(name, path)
    loaded = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(loaded)
    return loaded, path.read_text()


def expected(**changes):
    """theta_i, theta_s, delta_phi in degrees and f of 10 x 10 x 10 directions."""
    flags = [word for key, value in {**PARAMETERS, **changes}.items() for word in (f"--{key.replace('_', '-')}", str(value))]
    table = brdfit("simulate", "--theta-i", "0:81:9", "--theta-s", "2:83:9", "--delta-phi", "0:180:20", *flags)
    rows = [line.split(",") for line in table.splitlines()]
    order = [rows[0].index(name) for name in ("theta_i_deg", "theta_s_deg", "delta_phi_deg", "brdf_per_sr")]
    return np.array([[float(row[place]) for place in order] for row in rows[1:]])


def direction(theta, phi):
    theta, phi = np.radians(theta), np.radians(phi) + 0 * theta
    return mi.Vector3f(*(np.float32(part) for part in (np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta))))


def incident(theta):
    si = dr.zeros(mi.SurfaceInteraction3f, theta.size)
    si.wi = direction(theta, 0)
    return si


def evaluated(bsdf, theta_i, theta_s, delta_phi):
    """f cos theta_s."""
    return np.array(bsdf.eval(mi.BSDFContext(), incident(theta_i), direction(theta_s, delta_phi), True))[0]


def off(bsdf, rows):
    """The relative difference from f of each row."""
    theta_i, theta_s, delta_phi, f = rows.T
    return evaluated(bsdf, theta_i, theta_s, delta_phi) / np.cos(np.radians(theta_s)) / f - 1


rows = expected()
exact = mi.load_dict({"type": module("mitsuba", "exact")[0].NAME})
largest = np.abs(off(exact, rows)).max()
print(f"exact BSDF, {len(rows)} pairs of directions: largest relative difference {largest:.1e}")
assert len(rows) == 1000 and largest < 2e-5, largest

native, text = module("mitsuba-native", "native")
print("nearest native,", text.splitlines()[1].split(": ", 1)[1])
values = off(mi.load_dict(native.native), rows)
print(f"nearest native, these {len(rows)} pairs: {100 * values.min():+.1f} to {100 * values.max():+.1f} %")
values = off(mi.load_dict(module("mitsuba-native", "surface", rho_v=0)[0].surface), expected(rho_v=0))
print(f"nearest native without volume lobe: {100 * values.min():+.1f} to {100 * values.max():+.1f} %")

PAINT = {"rho_s": 0.5, "rho_v": 0, "m": 0.25, "n": 1.5, "kappa": 0}
paint, text = module("mitsuba-principled", "paint", **PAINT)
print("principled,", text.splitlines()[1][2:])
values = off(mi.load_dict(paint.paint), expected(**PAINT))
print(f"principled, these {len(rows)} pairs: {100 * values.min():+.1f} to {100 * values.max():+.1f} %")

# The mean weight of the samples is the reflectance.
count, random = 1_000_000, np.random.default_rng(0)
u, v, w = (mi.Float(np.float32(random.random(count))) for _ in range(3))
si = incident(np.full(count, 45.0))
weights = np.array(exact.sample(mi.BSDFContext(), si, u, mi.Point2f(v, w), True)[1])[0]
sampled, error = weights.mean(), weights.std() / count**0.5
cos, phi = (grid.ravel() for grid in np.meshgrid((np.arange(1000) + 0.5) / 1000, (np.arange(1000) + 0.5) * 0.18))
total = 2 * np.pi * evaluated(exact, np.full(cos.size, 45.0), np.degrees(np.arccos(cos)), phi).mean()
print(f"reflectance at 45 deg: {sampled:.4f} +- {error:.4f} by sampling, {total:.4f} by quadrature")
assert abs(sampled - total) < 4 * error + 1e-4 * total

if picture:
    scene = mi.load_dict({
        "type": "scene",
        "integrator": {"type": "path", "max_depth": 4},
        "sensor": {"type": "perspective", "fov": 28, "to_world": mi.ScalarTransform4f().look_at([0, -5, 1.2], [0, 0, 0], [0, 0, 1]),
                   "film": {"type": "hdrfilm", "width": 200, "height": 200, "rfilter": {"type": "gaussian"}},
                   "sampler": {"type": "multijitter", "sample_count": 64}},
        "ball": {"type": "sphere", "bsdf": {"type": module("mitsuba", "paint", rho_s=1.0)[0].NAME}},
        "light": {"type": "sphere", "center": [-4, -5, 5], "radius": 1.0, "emitter": {"type": "area", "radiance": {"type": "uniform", "value": 20.0}}},
        "sky": {"type": "constant", "radiance": {"type": "uniform", "value": 0.1}},
    })
    mi.util.write_bitmap(picture, mi.render(scene))
    print(f"rendered {picture}")

# Mitsuba reads tables of wavelengths in its spectral variants alone.
mi.set_variant("llvm_ad_spectral")
for changes in ({}, PAINT):
    parameters = ",".join(f"{key}={value}" for key, value in {**PARAMETERS, **changes}.items())
    table = folder / "table.bsdf"
    brdfit("export", "--params", parameters, "--to", "rgl", "--wavelength", "550", "--output", str(table))
    values = np.abs(off(mi.load_dict({"type": "measured", "filename": str(table)}), expected(**changes)))
    half, most, nearly_all = (np.percentile(values, share) for share in (50, 90, 99))
    print(f"measured: within {half:.1e} in half of the pairs, {most:.1e} in 90 %, {nearly_all:.1e} in 99 %")
    assert half < 1e-3 and most < 2e-2
