"""``python -m turnpath``: the whole program, with the strategies of installed packages."""

from __future__ import annotations

import sys
from pathlib import Path

from . import _turnpath
from ._recipe import Recipe
from ._session import Session
from ._strategies import sources


def main() -> int:
    """Runs the program with the arguments of the process: its exit status."""
    arguments = sys.argv[1:]
    session = Session(time_limit=None)
    recipe = next((one for one in arguments if Path(one).suffix == ".toml" and Path(one).is_file()), None)
    if recipe is not None:
        reach = _turnpath.reach(Recipe(recipe)._native())
        if reach is not None:
            session.half_width, session.fit_error = reach
    return _turnpath.main(["turnpath", *arguments], sources((), (), session))


if __name__ == "__main__":
    sys.exit(main())
