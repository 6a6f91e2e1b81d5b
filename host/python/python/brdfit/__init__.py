"""Finds the parameters of BRDF models from scatterometer scans.

The default model is the modified Cook-Torrance model of Bishop, Butler and Marciniak (2021), their Eq. 14; `MODELS` has the others.
All angles are in degrees and the BRDF is in sr^-1, as in the files of the program `brdfit`, and results have the program's bits.

>>> result = brdfit.fit(45, theta_s, measured)
>>> curve = brdfit.brdf(45, theta_s, result)
>>> for scan in brdfit.read("paint.astm", mask_retro=6):
...     brdfit.fit(scan, terms="auto", robust=True).plot()

| function | does |
|---|---|
| `read`, `scan` | a `Scan` from a file, or from arrays |
| `fit`, `fit_many` | the parameters of one scan, of many |
| `brdf` | the model at any angles |
| `profile` | which values of a parameter a scan allows; bootstrap |
| `compare` | which model a scan needs |
| `joint` | several scans that share parameters; the budget over repeats |
| `report`, `export` | the page on fits; the model for other programs |

What the program refuses is an `Error`, which is a `ValueError`: one line, with the kind of fault, the file and its line apart.
"""

from ._brdfit import Scan
from ._brdfit import models as _models
from ._errors import Error
from ._fit import brdf, fit, fit_many, read, scan
from ._options import Reading, Search
from ._studies import Comparison, Interval, Joint, Profile, Profiles, Repeats, compare, export, joint, profile, report
from .results import MESSAGES, NAMES, Fit, Fits, Minimum

MODELS: dict[str, str] = dict(_models())
"""Names of all models, with what each is."""

__all__ = [
    "MESSAGES",
    "MODELS",
    "NAMES",
    "Comparison",
    "Error",
    "Fit",
    "Fits",
    "Interval",
    "Joint",
    "Minimum",
    "Profile",
    "Profiles",
    "Reading",
    "Repeats",
    "Scan",
    "Search",
    "brdf",
    "compare",
    "export",
    "fit",
    "fit_many",
    "joint",
    "profile",
    "read",
    "report",
    "scan",
]
