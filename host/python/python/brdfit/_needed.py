"""Packages that only some functions need."""

from __future__ import annotations

from importlib import import_module
from typing import Any


def needed(module: str, by: str) -> Any:
    """A module that `by` needs.

    Raises
    ------
    ModuleNotFoundError : it is not installed; one line that says how to get it.
    """
    package = module.partition(".")[0]
    try:
        return import_module(module)
    except ModuleNotFoundError as error:
        if error.name != package:
            raise
        message = f"{by} needs {package}, which is not installed; get it with: pip install {package}"
        raise ModuleNotFoundError(message, name=package) from None
