"""Fits as they are shown: figures with Matplotlib, and notebooks."""

from __future__ import annotations

from html import escape
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from ._needed import needed

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from ._brdfit import Scan
    from .results import Fit

ANGLES = 12
"""Angles of incidence that are drawn at most."""


def signed(scan: Scan) -> NDArray[np.float64]:
    """theta_s in degrees, positive forward; NaN out of plane."""
    theta_s, delta_phi = scan.theta_s, scan.delta_phi % 360
    forward, backward = np.isclose(delta_phi, 180), np.isclose(delta_phi % 360, 0) | np.isclose(delta_phi, 360)
    return np.where(forward, theta_s, np.where(backward, -theta_s, np.nan))


def plot(fit: Fit, ax: Axes | None) -> Axes:
    """Log BRDF over the signed scattering angle: measured, left out by a robust fit, and fitted; in the plane of incidence."""
    if ax is None:
        made: Axes = needed("matplotlib.pyplot", "plot()").subplots()[1]
        ax = made
    scan = fit.scan
    theta_i, theta_s, measured = scan.theta_i, signed(scan), scan.brdf
    used = np.ones(len(scan), bool)
    used[list(fit.outliers)] = False
    angles = np.unique(theta_i[np.isfinite(theta_s)])
    shown = angles[np.unique(np.linspace(0, len(angles) - 1, ANGLES).astype(int))] if len(angles) > ANGLES else angles
    for angle in shown:
        here = (theta_i == angle) & np.isfinite(theta_s)
        grid = np.unique(np.concatenate([np.linspace(theta_s[here].min(), theta_s[here].max(), 721), theta_s[here]]))
        (line,) = ax.plot(grid, fit.curve(grid, angle), label=f"{angle:g}°")
        ax.plot(theta_s[here & used], measured[here & used], ".", color=line.get_color(), markersize=4)
        ax.plot(theta_s[here & ~used], measured[here & ~used], "x", color="0.6")
    ax.set_yscale("log")
    ax.set_xlabel("scattering angle, degrees, positive forward")
    ax.set_ylabel("BRDF, 1/sr")
    if len(shown) > 0:
        ax.legend(title="angle of incidence")
    outside = np.count_nonzero(np.isnan(theta_s))
    ax.set_title(f"{fit.model}, rms of ln BRDF {np.sqrt(fit.fun / fit.samples):.3g}" + (f", {outside} samples out of plane not shown" if outside else ""))
    return ax


def html(fit: Fit) -> str:
    """A table of the parameters, what is not determined, and the picture; for notebooks."""
    cells = [
        f"<tr><td>{escape(name)}</td><td>{value:.6g}</td><td>{escape(fit._known(name, error))}</td></tr>"
        for name, value, error in zip(fit.names, fit.x, fit.stderr)
    ]
    notes = [f"<p>{escape(note)}</p>" for note in fit.undetermined + fit.hints]
    head = f"{escape(fit.model)}: {escape(fit.message)}, rms of ln BRDF {np.sqrt(fit.fun / fit.samples):.3g} of {fit.samples} samples"
    return f"<div><p>{head}</p><table>{''.join(cells)}</table>{''.join(notes)}{fit.svg()}</div>"
