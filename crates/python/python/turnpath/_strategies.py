"""Strategies: what the decorators make of functions, and what the native part gets of them."""

from __future__ import annotations

import functools
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
from ._identity import NoIdentity, identity
from ._session import Session
from ._trace import Step, trace

#: The group of entry points in which packages name their strategies.
GROUP = "turnpath.strategies"


class TraceWarning(UserWarning):
    """A surface is no formula, and a spline stands for it."""


class EntryPointWarning(UserWarning):
    """An installed package names strategies that cannot be loaded."""


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
        _refuse_options(self.name, options)
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

    def identity(self) -> tuple[str | None, str]:
        """The hash of all that its answers depend on besides its parameters; or ``None``, and why there
        is none. :mod:`turnpath._identity` says what counts."""
        try:
            return identity(self._identity_parts(), self._modules()), ""
        except NoIdentity as error:
            return None, str(error)

    def _identity_parts(self) -> list[tuple[str, Any]]:
        """All that its answers depend on, by names for messages."""
        own = ("slot", "function", "name", "summary", "options", "params", "declaration", "version")
        known = {*own, *functools.WRAPPER_ASSIGNMENTS, "__wrapped__", "__type_params__"}
        # What a decorated function had already is written with the function.
        had = vars(self.function)
        more = [
            (key, value)
            for key, value in sorted(vars(self).items())
            if key not in known and not (key in had and had[key] is value)
        ]
        parts = [("slot", self.slot), ("declaration", self.declaration), ("function", self.function)]
        return [*parts, *sorted(self.options.items()), *more]

    def _modules(self) -> set[str]:
        functions = [self.function, *filter(inspect.isfunction, self.options.values())]
        return {function.__module__ for function in functions}

    def _native(self, session: Session) -> dict[str, Any]:
        session.strategies.append(self)
        own = {"surface": self._surface, "sampler": self._sampler}
        bind = own.get(self.slot, self._callable)
        return {
            "slot": self.slot,
            "declaration": self.declaration,
            "bind": session.guard(self, functools.partial(bind, session)),
            "identity": self.identity(),
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

    def _surface(
        self, session: Session, parameters: dict[str, Any], half_width: float, error: float
    ) -> Any:
        """The steps of the formula, and whether they are all that the function does; or a function to
        fit, half the side of the square that it must cover, and the error to reach, mm."""
        try:
            return trace(self.function, parameters)
        except TraceError as why:
            if self.options["fit"] is False:
                raise
            note = (
                f"the surface `{self.name}` cannot be traced: {why}; a spline through its heights "
                "stands for it"
            )
            if note not in session.notes:
                session.notes.append(note)
            _source.warn_at(self.function, note, TraceWarning)
        extent, goal = self.options["extent"], self.options["fit_error"]
        half = half_width if extent is None else 0.5 * _turnpath.parse_quantity("length", extent)
        goal = error if goal is None else _turnpath.parse_quantity("length", goal)
        return self._callable(session, parameters), half, goal


#: What options of decorators may be.
_WORDS = {"radial": ("contact", "centre"), "segments": ("cubic", "linear")}
_LENGTHS = ("extent", "fit_error")
#: The most nodes that a velocity solver may ask for on either side of a block.
_MOST_OVERLAP = 10_000


def _refuse_options(name: str, options: dict[str, Any]) -> None:
    """Options that mean nothing are refused where they are written."""
    for key, value in options.items():
        wrong = None
        if key in _WORDS and value not in _WORDS[key]:
            wrong = f"{value!r}, and may be {' or '.join(map(repr, _WORDS[key]))}"
        elif key in _LENGTHS and value is not None:
            wrong = _wrong_length(value)
        elif key == "overlap" and (type(value) is not int or not 0 <= value <= _MOST_OVERLAP):
            wrong = f"{value!r}, and is a count of nodes up to {_MOST_OVERLAP}"
        elif key == "plan" and not (value is None or callable(value)):
            wrong = f"{value!r}, and is a function"
        if wrong is not None:
            raise ValueError(f"{name}: the option `{key}` is {wrong}")


def _wrong_length(text: Any) -> str | None:
    try:
        length = _turnpath.parse_quantity("length", text)
    except (TypeError, ValueError) as error:
        return f"{text!r}: {error}"
    return None if length > 0 else f"{text!r}, and is longer than 0 mm"


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
    """The strategies of installed packages: those that their entry points name. A package whose
    strategies cannot be loaded is named in an :class:`EntryPointWarning`."""
    points = importlib.metadata.entry_points(group=GROUP)
    found: list[Strategy] = []
    for point in points:
        try:
            strategies = flat(point.load())
        except Exception as error:
            of = point.dist.name if point.dist is not None else point.value
            said = f"{type(error).__name__}: {error}"
            text = f"the strategies of the package `{of}` cannot be loaded, and are left out: {said}"
            warnings.warn(text, EntryPointWarning, stacklevel=2)
            continue
        for strategy in strategies:
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
    # What is in no file stands alone: nothing else of its place can be told from it.
    places: dict[tuple[str, str], list[Strategy]] = {}
    for strategy in given:
        in_file = _source.has_file(strategy.function)
        place = _source.file_of(strategy.function)
        of = "" if in_file else f"{strategy.slot} {strategy.name}"
        places.setdefault((place, of), []).append(strategy)
    modules = [_module(place, of_place, session) for (place, _), of_place in places.items()]
    return modules, [Path(plugin) for plugin in plugins]


def _module(place: str, strategies: list[Strategy], session: Session) -> dict[str, Any]:
    """The strategies of one file, or one that is in none, for the native part."""
    function = strategies[0].function
    name = function.__module__
    return {
        "name": Path(place).stem if name == "__main__" else name,
        "version": str(getattr(strategies[0], "version", "0")),
        "place": place,
        "sha256": _source.sha256(function),
        "strategies": [one._native(session) for one in strategies],
    }
