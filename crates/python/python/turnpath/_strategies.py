"""Strategies: what the decorators make of functions, and what the native part gets of them."""

from __future__ import annotations

import functools
import hashlib
import importlib.metadata
import inspect
import json
import os
import warnings
from collections.abc import Iterable
from pathlib import Path
from typing import Any, Callable

from . import _kinds, _source, _turnpath
from ._errors import TraceError
from ._session import Session
from ._trace import Step, trace

#: The group of entry points in which packages name their strategies.
GROUP = "turnpath.strategies"


class TraceWarning(UserWarning):
    """A surface is no formula, and a spline stands for it."""


class Strategy:
    """A strategy that is written in Python. It can still be called as the function that it is.

    Attributes:
        slot: the slot that it fills.
        name: its name in recipes.
        summary: the first line of its docstring.
        function: the function.
    """

    def __init__(
        self,
        slot: str,
        skipped: int,
        function: Callable[..., Any],
        name: str | None,
        options: dict[str, Any],
    ) -> None:
        functools.update_wrapper(self, function)
        self.slot = slot
        self.function = function
        self.name = name or function.__name__.strip("_").replace("_", "-").lower()
        self.summary = (inspect.getdoc(function) or "").partition("\n")[0]
        self.options = options
        self.params = _kinds.declare(function, skipped)
        self.declaration = json.dumps(
            {"name": self.name, "summary": self.summary, "params": self.params}
        )

    def __call__(self, *args: Any, **kwargs: Any) -> Any:
        return self.function(*args, **kwargs)

    def __repr__(self) -> str:
        return f"<turnpath {self.slot} {self.name!r} of {_source.file_of(self.function)}>"

    def trace(self, **parameters: Any) -> list[Step]:
        """The steps of the formula that a surface is.

        Raises:
            TraceError: when it is none, and why.
        """
        return trace(self.function, {**self._defaults(), **parameters})[0]

    def _defaults(self) -> dict[str, Any]:
        """A value for each parameter: its default, else any that it may have."""

        def value(param: dict[str, Any]) -> Any:
            kind, default = param["kind"], param["default"]
            if isinstance(default, dict):
                found = next(iter(default.values()))
                return int(found) if kind == "count" else found
            if default == "absent":
                return None
            if isinstance(kind, dict) and "choice" in kind:
                return kind["choice"][0]
            least = max(param.get("min", 1.0), 1.0)
            plain = {"count": int(least), "flag": False, "text": "", "file": b""}
            return plain.get(kind, least) if isinstance(kind, str) else least

        return {param["name"]: value(param) for param in self.params}

    def digest(self) -> str:
        """Slot, name, and the SHA-256 of the sources of its functions."""
        functions = [self.function, *filter(callable, self.options.values())]
        return " ".join([self.slot, self.name, *map(_source.digest, functions)])

    def is_exact(self) -> bool:
        """Whether its answers have the same bytes on every machine: it is a surface, and all of it
        is a formula."""
        if self.slot != "surface":
            return False
        try:
            return trace(self.function, self._defaults())[1]
        except TraceError:
            return False

    def _native(self, session: Session) -> dict[str, Any]:
        session.strategies.append(self)
        own = {"surface": self._surface, "sampler": self._sampler}
        bind = own.get(self.slot, self._callable)
        return {
            "slot": self.slot,
            "declaration": self.declaration,
            "bind": session.guard(self, functools.partial(bind, session)),
            "exact": self.is_exact(),
            "options": {
                key: value
                for key, value in self.options.items()
                if isinstance(value, (bool, int, str))
            },
        }

    def _callable(self, session: Session, parameters: dict[str, Any]) -> Callable[..., Any]:
        return session.guard(self, functools.partial(self.function, **parameters))

    def _sampler(self, session: Session, parameters: dict[str, Any]) -> tuple[Any, Any]:
        """What places the nodes of a block, and what plans them, if anything does."""
        plan = self.options["plan"]
        if plan is not None:
            plan = session.guard(self, functools.partial(plan, **parameters))
        return self._callable(session, parameters), plan

    def _surface(self, session: Session, parameters: dict[str, Any]) -> Any:
        """The steps of the formula, or a function to fit, its half width and the error to reach."""
        try:
            return trace(self.function, parameters)[0]
        except TraceError as error:
            if self.options.get("fit") is False:
                raise
            half, goal = self._extent(session, error), self._goal(session)
            note = (
                f"the surface `{self.name}` cannot be traced: {error}; a spline through its heights "
                "stands for it"
            )
            session.notes.append(note)
            warnings.warn(note, TraceWarning, stacklevel=2)
            return (self._callable(session, parameters), half, goal)

    def _extent(self, session: Session, why: TraceError) -> float:
        """Half the width of the square that a spline covers, mm."""
        if self.options.get("extent") is not None:
            return 0.5 * _turnpath.parse_quantity("length", self.options["extent"])
        if session.half_width is None:
            raise TraceError(
                f"{why}; for a spline in its place say how large it is: "
                "@turnpath.surface(extent='60 mm')"
            ) from why
        return session.half_width

    def _goal(self, session: Session) -> float:
        """The error of a spline that is small enough, mm."""
        if self.options.get("fit_error") is not None:
            return _turnpath.parse_quantity("length", self.options["fit_error"])
        return session.fit_error


def _decorator(slot: str, skipped: int, function: Any, name: str | None, **options: Any) -> Any:
    if function is None:
        return lambda function: Strategy(slot, skipped, function, name, options)
    return Strategy(slot, skipped, function, name, options)


def surface(
    function: Any = None,
    *,
    name: str | None = None,
    fit: bool = True,
    extent: str | None = None,
    fit_error: str | None = None,
) -> Any:
    """Makes a surface of a function ``f(x, y, **parameters) -> z``, all in mm.

    Where the function is a plain expression it is traced into a formula, which has exact slopes and
    the speed of a surface that is built in. Else it is called once for the points of a grid, as arrays
    of one length, and a spline of degree 5 through its heights takes its place. The path's own loops
    never call it.

    Args:
        name: the name in recipes; the function's unless given.
        fit: whether a spline may take its place.
        extent: the side of the square that a spline covers; from the recipe's part unless given.
        fit_error: the error at which a spline is fine enough; a twentieth of the interpolation
            tolerance unless given.
    """
    return _decorator("surface", 2, function, name, fit=fit, extent=extent, fit_error=fit_error)


def feed(function: Any = None, *, name: str | None = None) -> Any:
    """Makes a feed strategy of a function ``f(setup, **parameters) -> pieces``.

    ``setup`` is a :class:`turnpath.Setup`. ``pieces`` has the shape (n, 7): the length of each piece in
    revolutions, then the six coefficients of ρ in mm against the revolutions since its start, lowest
    first. :func:`turnpath.between` makes a piece.
    """
    return _decorator("feed", 1, function, name)


def sampler(
    function: Any = None,
    *,
    name: str | None = None,
    plan: Callable[..., Any] | None = None,
    needs_exact_rates: bool = False,
) -> Any:
    """Makes a sampler of a function ``f(path, block, **parameters) -> revolutions``.

    ``path`` is a :class:`turnpath.Path`, ``block`` a :class:`turnpath.Block`. The answer is a column of
    increasing revolutions from ``block.start`` (included) to ``block.end`` (excluded). Or it is a
    tuple of three columns: revolutions, how far each node lies above the locus in mm, and what it adds to
    dZ/dθ in mm/rad; then ``needs_exact_rates`` must be true.

    Args:
        plan: a function ``plan(path, **parameters)`` that looks at the whole path once, before any block.
            What it gives is the third argument of ``f``: ``f(path, block, plan, **parameters)``.
        needs_exact_rates: whether the nodes hold the tolerance only with the exact rates of the path.
    """
    options = {"plan": plan, "needs_exact_rates": needs_exact_rates}
    return _decorator("sampler", 2 if plan is None else 3, function, name, **options)


def compensator(
    function: Any = None,
    *,
    name: str | None = None,
    radial: str = "contact",
    compensates_nose: bool = True,
) -> Any:
    """Makes a compensator of a function ``f(cut, theta, rho, **parameters) -> (x, z, foot)``.

    ``cut`` is a :class:`turnpath.Cut`; ``theta`` is in rad, ``rho`` in mm. The answer has three columns of
    their length: x and z of the nose centre and the radius of its contact, in mm.

    Args:
        radial: what ρ means: ``"contact"``, the radius of the contact, or ``"centre"``, x of the nose
            centre.
        compensates_nose: whether the path is that of the nose centre.
    """
    options = {"radial": radial, "compensates_nose": compensates_nose}
    return _decorator("compensator", 3, function, name, **options)


def velocity(
    function: Any = None,
    *,
    name: str | None = None,
    overlap: int = 0,
    segments: str = "cubic",
    exact_rates: bool = False,
) -> Any:
    """Makes a velocity solver of a function ``f(nodes, **parameters) -> (vc, vx, vz)``.

    ``nodes`` is a dict of columns of one length: ``t`` (s), ``c`` (rad), ``x`` and ``z`` (mm), ``c_rate``
    (rad/s), ``x_rate`` and ``z_rate`` (mm/s) of the path itself, ``z_theta`` (mm/rad) and ``z_x``, and of
    the flags ``at_start`` and ``at_end``. The answer has three columns, in rad/s and mm/s.

    Args:
        overlap: how many nodes before and after a block it needs.
        segments: what the controller plays: ``"cubic"`` or ``"linear"``.
        exact_rates: whether the velocities are those of the path itself.
    """
    options = {"overlap": overlap, "segments": segments, "exact_rates": exact_rates}
    return _decorator("velocity", 1, function, name, **options)


def spindle(
    function: Any = None, *, name: str | None = None, follows_factors: bool = False
) -> Any:
    """Makes a spindle strategy of a function ``f(path, speed, factors, **parameters) -> pieces``.

    ``speed`` is the largest speed in rad/s. ``factors`` has, for each half turn, the part of it at which
    the axes keep the machine's limits; it is empty at first. ``pieces`` has the shape (n, 7): lengths in
    revolutions, then the six coefficients of the time in s against the revolutions since the piece's
    start.

    Args:
        follows_factors: whether it uses ``factors``.
    """
    return _decorator("spindle", 3, function, name, follows_factors=follows_factors)


def flat(strategies: Iterable[Any] | Any) -> list[Strategy]:
    """The strategies of a list, of a module, or of lists of these."""
    if isinstance(strategies, Strategy):
        return [strategies]
    if inspect.ismodule(strategies):
        return [one for one in vars(strategies).values() if isinstance(one, Strategy)]
    if isinstance(strategies, (str, bytes)) or not isinstance(strategies, Iterable):
        raise TypeError(
            f"{strategies!r} is no strategy: decorate a function with @turnpath.sampler or another slot"
        )
    return [one for part in strategies for one in flat(part)]


@functools.lru_cache(maxsize=1)
def installed() -> tuple[Strategy, ...]:
    """The strategies of installed packages: those that their entry points name."""
    points = importlib.metadata.entry_points(group=GROUP)
    found: list[Strategy] = []
    for point in points:
        for strategy in flat(point.load()):
            if point.dist is not None and strategy not in found:
                strategy.version = point.dist.version
            found.append(strategy)
    return tuple(dict.fromkeys(found))


def sources(
    strategies: Iterable[Any], plugins: Iterable[str | os.PathLike[str]], session: Session
) -> tuple[list[dict[str, Any]], list[Path]]:
    """The given strategies and the installed ones, by their files, and the plugins, for the native
    part. A given one takes the place of an installed one of its name."""
    given = list(dict.fromkeys(flat(strategies)))
    taken = {(one.slot, one.name) for one in given}
    given += [one for one in installed() if (one.slot, one.name) not in taken]
    files: dict[str, list[Strategy]] = {}
    for strategy in given:
        files.setdefault(_source.file_of(strategy.function), []).append(strategy)
    modules = [_module(file, of_file, session) for file, of_file in files.items()]
    return modules, [Path(plugin) for plugin in plugins]


def _module(file: str, strategies: list[Strategy], session: Session) -> dict[str, Any]:
    hashes = sorted(one.digest() for one in strategies)
    name = strategies[0].function.__module__
    return {
        "name": Path(file).stem if name == "__main__" else name,
        "version": str(getattr(strategies[0], "version", "0")),
        "place": file,
        "sha256": hashlib.sha256("\n".join(hashes).encode()).hexdigest(),
        "strategies": [one._native(session) for one in strategies],
    }
