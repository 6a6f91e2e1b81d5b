"""Commands of the program, and what they write."""

from __future__ import annotations

import os
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from . import _brdfit, _options

BINARY = "rgl"
"""The form of export that is no text."""


def run(command: str, words: Iterable[str], scans: str) -> bytes:
    """What a command prints whose input is `scans`."""
    return _brdfit.command([command, "-", *words], scans.encode())


def exported(result: str, to: str, path: str | os.PathLike[str] | None = None, **options: Any) -> str | bytes:
    """The model of a result in JSON as `brdfit export --to` writes it, and into a file if `path` names one; bytes where the form is no text."""
    own = {"to": to, **options}
    written = run("export", _options.words(own, own, "export"), result)
    if path is not None:
        Path(path).write_bytes(written)
    return written if to == BINARY else written.decode()


def write(text: str, path: str | os.PathLike[str] | None) -> None:
    """Writes a file, if `path` names one, with the line ends as they are."""
    if path is not None:
        Path(path).write_text(text, encoding="utf-8", newline="\n")
