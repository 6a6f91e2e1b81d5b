"""The program `brdfit`, as `python -m brdfit` and as the command of the package."""

import sys

from ._brdfit import main as _main


def main() -> int:
    """Runs the program on the arguments of the process."""
    return _main(["brdfit", *sys.argv[1:]])


if __name__ == "__main__":
    sys.exit(main())
