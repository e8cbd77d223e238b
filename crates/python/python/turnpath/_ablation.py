"""Ablations: all runs of one, and its parts for a queue."""

from __future__ import annotations

import csv
import json
import tempfile
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from . import _turnpath
from ._commands import PathLike, Progress, Report, threads_of
from ._recipe import RecipeLike, as_recipe
from ._session import TIME_LIMIT, Session
from ._strategies import sources


class Rows(list[dict[str, Any]]):
    """The rows of an ablation, as ``pandas.DataFrame(rows)`` takes them: a dict for each run. A row has
    its number ``run``, what varies in words, the figures with units in their names, ``reason`` where the
    run failed, and ``not_recorded``: why the run has no record and is made each time, or ``None``.

    Attributes:
        report: the whole report.
        files: the files that were written; empty without a folder.
        reused: how many runs had a record already.
    """

    report: dict[str, Any]
    files: list[Path]
    reused: int


def ablate(
    recipe: RecipeLike,
    vary: Mapping[str, Any] | None = None,
    set: Mapping[str, Any] | None = None,
    strategies: Iterable[Any] = (),
    *,
    plugins: Iterable[PathLike] = (),
    folder: PathLike | None = None,
    fresh: bool = False,
    progress: Progress | None = None,
    threads: int = 0,
    time_limit: float | None = TIME_LIMIT,
) -> Rows:
    """Makes the variants of a recipe and sets their figures side by side.

    Args:
        vary: lists for the recipe's ``[ablation]``: ``{"sampler": [{"use": "even"}, …]}``.
        folder: where the table and the records of runs go. A run that has a record is not made again.
            Without a folder nothing is kept.
        fresh: whether runs that have a record are made again.
        threads: how many runs are made at a time; as many as there are cores for 0.

    The other arguments are those of :func:`run`.
    """
    count = threads_of(threads)
    native = _varied(recipe, vary, set)
    session = Session(time_limit)
    found = sources(strategies, plugins, session)
    with tempfile.TemporaryDirectory(prefix="turnpath-") as scratch:
        answer = session.work(
            lambda: _turnpath.ablate(
                native,
                found,
                session.control,
                Path(scratch if folder is None else folder),
                fresh=fresh,
                threads=count,
            ),
            progress,
        )
        rows = _rows(answer)
    if folder is None:
        rows.files = []
    return rows


def plan(
    recipe: RecipeLike,
    vary: Mapping[str, Any] | None = None,
    set: Mapping[str, Any] | None = None,
    strategies: Iterable[Any] = (),
    *,
    folder: PathLike,
    plugins: Iterable[PathLike] = (),
) -> list[dict[str, Any]]:
    """The runs of an ablation, none of which is made: dicts with ``index``, from 0; ``key``, which
    :func:`run_of` takes; ``varied``, what varies in words; and ``state``, as the records in ``folder``
    say: ``"done"``, ``"failed"``, ``"begun"`` (being made, or lost with its process) or ``"missing"``.

    A strategy of Python that takes values without an exact hash has no key: that is a
    :class:`RecipeError`. The arguments are those of :func:`ablate`.
    """
    native = _varied(recipe, vary, set)
    session = Session()
    found = sources(strategies, plugins, session)
    text = session.work(lambda: _turnpath.plan(native, found, Path(folder)))
    runs: list[dict[str, Any]] = json.loads(text)["runs"]
    return runs


def run_of(
    key: str,
    recipe: RecipeLike,
    vary: Mapping[str, Any] | None = None,
    set: Mapping[str, Any] | None = None,
    strategies: Iterable[Any] = (),
    *,
    folder: PathLike,
    plugins: Iterable[PathLike] = (),
    time_limit: float | None = TIME_LIMIT,
) -> Report:
    """Makes the run of an ablation that has this key, and leaves its record in ``folder``: what a job of
    a queue calls. A run that fails leaves a record with the reason, and raises it.

    Any number of these may work at a time, in any process that sees the folder. The other arguments are
    those of :func:`plan`; ``report`` is the run's entry of ``ablation.json``.
    """
    native = _varied(recipe, vary, set)
    session = Session(time_limit)
    found = sources(strategies, plugins, session)
    text = session.work(
        lambda: _turnpath.run_of(native, found, session.control, Path(folder), key)
    )
    return Report(text, session)


def merge(
    recipe: RecipeLike,
    vary: Mapping[str, Any] | None = None,
    set: Mapping[str, Any] | None = None,
    strategies: Iterable[Any] = (),
    *,
    folder: PathLike,
    plugins: Iterable[PathLike] = (),
) -> Rows:
    """The rows of an ablation from the records in ``folder``, and its files. Nothing is made: a run
    without a record is a row whose ``reason`` says so. The arguments are those of :func:`plan`."""
    native = _varied(recipe, vary, set)
    session = Session()
    found = sources(strategies, plugins, session)
    return _rows(
        session.work(lambda: _turnpath.merge(native, found, session.control, Path(folder)))
    )


def _varied(
    recipe: RecipeLike, vary: Mapping[str, Any] | None, set: Mapping[str, Any] | None
) -> tuple[str, str, list[str]]:
    """The recipe with its lists, for the native part."""
    changes = dict(set or {})
    changes |= {f"ablation.{key}": value for key, value in (vary or {}).items()}
    return as_recipe(recipe, changes)._native()


def _rows(answer: tuple[str, list[Any], int]) -> Rows:
    """The rows of what the native part gave: report, files, and how many runs had a record."""
    text, files, reused = answer
    report = json.loads(text)
    paths = [Path(file) for file in files]
    table = next(path for path in paths if path.suffix == ".csv")
    with table.open(newline="", encoding="utf-8") as lines:
        written = list(csv.DictReader(lines))
    rows = Rows(_row(one, run) for one, run in zip(written, report["runs"]))
    rows.report, rows.files, rows.reused = report, paths, reused
    return rows


def _row(written: dict[str, str], run: dict[str, Any]) -> dict[str, Any]:
    """A line of the table with its types. What varies is text, whatever it looks like."""
    varied = run["varied"]
    row = {
        key: varied[key] if key in varied else _cell(key, text) for key, text in written.items()
    }
    return {**row, "not_recorded": run.get("not_recorded")}


def _cell(column: str, text: str) -> Any:
    """What stands in a column of the table; ``None`` for nothing."""
    if text == "" or column in ("reason", "not_recorded"):
        return text or None
    if column.startswith("within_"):
        return text == "true"
    # Only counts are written without a point or an exponent.
    return int(text) if text.isdecimal() else float(text)
