"""``python -m turnpath``: the whole program, with the strategies of installed packages."""

from __future__ import annotations

import sys

from . import _turnpath
from ._errors import Error, FileError, StrategyError
from ._session import Session
from ._strategies import sources


def main() -> int:
    """Runs the program with the arguments of the process: its exit status."""
    try:
        return _turnpath.main(["turnpath", *sys.argv[1:]], sources((), (), Session(time_limit=None)))
    except Error as error:
        print(f"error: {error}", file=sys.stderr)
        return {StrategyError: 3, FileError: 4}.get(type(error), 2)


if __name__ == "__main__":
    sys.exit(main())
