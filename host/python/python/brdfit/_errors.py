"""What is raised where the program refuses."""

from __future__ import annotations

from . import _options


class Error(ValueError):
    """What is wrong with a file, a scan or an option, and what to do about it, in one line.

    Attributes
    ----------
    kind : what is at fault: "options", "input" (what a file or a scan says), "file" (it cannot be read or written), "fit" (the samples allow no such fit) or "interrupted".
    file : the file at fault, or None.
    line : the line in it, from 1, or None.
    column : the column of its table, from 1, or None.
    """

    def __init__(
        self,
        message: str,
        kind: str = "options",
        file: str | None = None,
        line: int | None = None,
        column: int | None = None,
    ) -> None:
        super().__init__(message, kind, file, line, column)
        self.kind = kind
        self.file = file
        self.line = line
        self.column = column

    def __str__(self) -> str:
        # The program calls its options as on the command line.
        return _options.in_python(str(self.args[0]))
