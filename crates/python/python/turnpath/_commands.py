"""The commands: run, check, verify, and the list of strategies."""

from __future__ import annotations

import json
import operator
import os
import tempfile
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from . import _turnpath
from ._recipe import Recipe, RecipeLike, as_recipe
from ._session import TIME_LIMIT, Session
from ._strategies import sources

Progress = Callable[[str, int, int], Any]
PathLike = str | os.PathLike[str]


class ToolPath(NamedTuple):
    """A tool path: columns of one length, a row for each control point, from lead-in to lead-out."""

    #: 0 in the lead-in, 1 in the cut, 2 in the lead-out; shape (n,), uint8.
    section: np.ndarray
    #: Time, s; shape (n,).
    t: np.ndarray
    #: C, unwrapped, rad; shape (n,).
    c: np.ndarray
    #: X of the nose centre, mm; shape (n,).
    x: np.ndarray
    #: Z of the nose centre, mm; shape (n,).
    z: np.ndarray
    #: dC/dt, rad/s; shape (n,).
    vc: np.ndarray
    #: dX/dt, mm/s; shape (n,).
    vx: np.ndarray
    #: dZ/dt, mm/s; shape (n,).
    vz: np.ndarray


class Map(NamedTuple):
    """The machined surface less the wanted one, along z."""

    #: x of the columns, mm; shape (n,).
    x: np.ndarray
    #: y of the rows, mm; shape (n,).
    y: np.ndarray
    #: The difference at (x, y), mm; shape (n, n), a row for each y; NaN off the part.
    dz: np.ndarray


class Report:
    """A report of turnpath, as its JSON has it; docs/measuring.md says what each key means.

    Attributes:
        report: the figures, as a dict whose keys have units.
        notes: what the caller should know of the strategies, such as why one was not traced.
    """

    def __init__(self, text: str, session: Session) -> None:
        self.report: dict[str, Any] = json.loads(text)
        self.notes = tuple(session.notes)


class Judgement(Report):
    """A report on a path that was measured, with its verdict."""

    @property
    def verdict(self) -> dict[str, bool | None]:
        """Which tolerances and limits hold; ``None`` for what the recipe does not ask for."""
        return self.report["within"]

    @property
    def holds(self) -> bool:
        """Whether all tolerances and limits hold."""
        return all(holds is not False for holds in _entries(self.verdict))


def _entries(verdict: Any) -> Iterable[Any]:
    """The answers of a verdict, at whatever depth."""
    if isinstance(verdict, Mapping):
        return [one for part in verdict.values() for one in _entries(part)]
    return [verdict]


class Result(Judgement):
    """What a run gave.

    Attributes:
        recipe: the recipe that was run.
        files: the files that were written, the summary last; empty without a folder.
    """

    def __init__(self, answer: Any, run: _Run) -> None:
        text, files, columns, programs = answer
        super().__init__(text, run.session)
        self.recipe = run.recipe
        self.files = [Path(file) for file in files]
        self._run = run
        self._toolpath = None if columns is None else ToolPath(**columns)
        self._programs = {name: bytes(text) for name, text in programs}

    @property
    def toolpath(self) -> ToolPath:
        """The path as columns. After a run into a folder it is made once more."""
        if self._toolpath is None:
            self._toolpath = self._run.again(None, None)._toolpath
            assert self._toolpath is not None
        return self._toolpath

    @property
    def programs(self) -> dict[str, bytes]:
        """The motion programs by their file names; of a run into a folder, what the files hold."""
        if not self.files:
            return self._programs
        listed = {one["file"] for one in self.report.get("programs", [])}
        return {file.name: file.read_bytes() for file in self.files if file.name in listed}

    def map(self, n: int) -> Map:
        """The machined surface less the wanted one on ``n`` × ``n`` cells over the square around the
        part. The path is made once more for it."""
        n = operator.index(n)
        if n not in CELLS:
            raise ValueError(f"a map of {n} cells; it has from {CELLS[0]} to {CELLS[-1]} along a side")
        with tempfile.TemporaryDirectory(prefix="turnpath-") as folder:
            file = Path(folder) / "map.xyz"
            changes = {"output.data": ["csv"], "output.posts": []}
            self._run.again(Path(folder) / "out", (file, n), changes)
            return _read_map(file, n)


def _read_map(file: Path, n: int) -> Map:
    """Lines of x, y and z: in mm, on a grid with holes."""
    table = np.loadtxt(file, comments=("#", "!"), ndmin=2)
    x, column = np.unique(table[:, 0], return_inverse=True)
    y, row = np.unique(table[:, 1], return_inverse=True)
    dz = np.full((len(y), len(x)), np.nan)
    dz[row, column] = table[:, 2]
    return Map(x, y, dz)


class _Run:
    """What a run is made from, so that it can be made again."""

    def __init__(
        self,
        recipe: Recipe,
        strategies: Iterable[Any],
        plugins: Iterable[PathLike],
        session: Session,
        threads: int,
    ) -> None:
        self.recipe = recipe
        self.strategies = list(strategies)
        self.plugins = list(plugins)
        self.session = session
        self.threads = threads_of(threads)

    def again(
        self,
        folder: Path | None,
        map: tuple[Path, int] | None,
        changes: Mapping[str, Any] | None = None,
        progress: Progress | None = None,
    ) -> Result:
        native = as_recipe(self.recipe, changes)._native()
        self.session = Session(self.session.time_limit)
        found = sources(self.strategies, self.plugins, self.session)
        session = self.session
        answer = session.work(
            lambda: _turnpath.run(
                native, found, session.control, folder=folder, map=map, threads=self.threads
            ),
            progress,
        )
        return Result(answer, self)


#: The most threads that a command may have, as of `turnpath --threads`.
MOST_THREADS = 1024
#: The cells along each side that a map may have, as of `turnpath --map-cells`.
CELLS = range(2, 20_001)


def threads_of(threads: int) -> int:
    """How many threads work, if that is a count."""
    count = operator.index(threads)
    if not 0 <= count <= MOST_THREADS:
        raise ValueError(f"threads is {count}; it is from 1 to {MOST_THREADS}, or 0 for all cores")
    return count


def run(
    recipe: RecipeLike,
    set: Mapping[str, Any] | None = None,
    strategies: Iterable[Any] = (),
    *,
    plugins: Iterable[PathLike] = (),
    folder: PathLike | None = None,
    progress: Progress | None = None,
    threads: int = 0,
    time_limit: float | None = TIME_LIMIT,
) -> Result:
    """Makes the path of a recipe and measures it.

    The work runs on threads of its own, without the interpreter's lock; Ctrl-C ends it.

    Args:
        recipe: a :class:`Recipe`, the path of a file, or a dict.
        set: values in the places of the recipe's own: ``{"tolerance.residual": "50 nm"}``.
        strategies: strategies of Python, or modules of them, beside those that are built in or installed.
        plugins: folders and libraries of plugins: native code with your rights.
        folder: where the files of the result go; nowhere unless given.
        progress: is called with the stage, how many blocks of it are done, and of how many.
        threads: how many threads work; as many as there are cores for 0.
        time_limit: the longest single call of a strategy of Python, s; ``None`` for no limit.

    Raises:
        RecipeError: when the recipe asks for what cannot be done.
        StrategyError: when a strategy fails.
        FileError: when a file cannot be read or written.
    """
    made = _Run(as_recipe(recipe, set), strategies, plugins, Session(time_limit), threads)
    return made.again(None if folder is None else Path(folder), None, None, progress)


def check(
    recipe: RecipeLike,
    set: Mapping[str, Any] | None = None,
    strategies: Iterable[Any] = (),
    *,
    plugins: Iterable[PathLike] = (),
    progress: Progress | None = None,
    threads: int = 0,
    time_limit: float | None = TIME_LIMIT,
) -> Report:
    """Checks a recipe and estimates its path, which is not made. The arguments are those of
    :func:`run`."""
    count = threads_of(threads)
    native = as_recipe(recipe, set)._native()
    session = Session(time_limit)
    found = sources(strategies, plugins, session)
    text = session.work(
        lambda: _turnpath.check(native, found, session.control, threads=count), progress
    )
    return Report(text, session)


def verify(
    recipe: RecipeLike,
    file: PathLike,
    set: Mapping[str, Any] | None = None,
    strategies: Iterable[Any] = (),
    *,
    plugins: Iterable[PathLike] = (),
    progress: Progress | None = None,
    threads: int = 0,
    time_limit: float | None = TIME_LIMIT,
) -> Judgement:
    """Measures the tool path in a file, a ``toolpath.csv`` or a motion program, against a recipe. The
    other arguments are those of :func:`run`."""
    count = threads_of(threads)
    native = as_recipe(recipe, set)._native()
    session = Session(time_limit)
    found = sources(strategies, plugins, session)
    text = session.work(
        lambda: _turnpath.verify(native, found, session.control, Path(file), threads=count),
        progress,
    )
    return Judgement(text, session)


def strategies(
    own: Iterable[Any] = (), *, plugins: Iterable[PathLike] = ()
) -> list[dict[str, str]]:
    """All strategies, those of ``own`` and of ``plugins`` among them: dicts with ``slot``, ``name``, ``summary`` and
    ``plugin``."""
    session = Session()
    given = sources(own, plugins, session)
    found = session.work(lambda: _turnpath.strategies(given))
    return [dict(zip(("slot", "name", "summary", "plugin"), row)) for row in found]
