"""Kinds of parameters, as annotations of a strategy's signature."""

from __future__ import annotations

import inspect
import numbers
import typing
from dataclasses import dataclass
from typing import Any, Callable

from . import _turnpath


class Kind:
    """A kind of parameters that carries a unit. Inside a strategy its value is a ``float``."""

    def __init__(self, word: str, inside: str) -> None:
        self.word = word
        self.__doc__ = f"{word.replace('-', ' ')}; inside a strategy a number in {inside}."

    def __call__(self, *_: Any) -> Any:
        raise TypeError("a kind is an annotation: write `pitch: turnpath.Length = '1 mm'`")

    def __or__(self, other: Any) -> Any:
        return typing.Union[self, other]

    def __repr__(self) -> str:
        return f"turnpath kind {self.word}"


Length = Kind("length", "mm")
Angle = Kind("angle", "rad")
PerLength = Kind("per-length", "1/mm")
Feed = Kind("feed", "mm per revolution")
RotationSpeed = Kind("rotation-speed", "rad/s")
Frequency = Kind("frequency", "rad/s")
Time = Kind("time", "s")
Velocity = Kind("velocity", "mm/s")
Acceleration = Kind("acceleration", "mm/s²")
Jerk = Kind("jerk", "mm/s³")
AngularAcceleration = Kind("angular-acceleration", "rad/s²")
AngularJerk = Kind("angular-jerk", "rad/s³")


class File:
    """A file that the recipe names. turnpath reads and hashes it; the strategy gets its ``bytes``."""


@dataclass(frozen=True)
class Limits:
    """Which values a parameter takes, and its line of help, in ``typing.Annotated``.

    ``typing.Annotated[turnpath.Length, turnpath.Limits(positive=True, help="largest arc")]``

    Bounds of quantities are texts with units.
    """

    min: str | float | None = None
    max: str | float | None = None
    positive: bool = False
    nonzero: bool = False
    help: str = ""


_PLAIN = {float: "number", int: "count", bool: "flag", str: "text", File: "file"}


def declare(function: Callable[..., Any], skipped: int) -> list[dict[str, Any]]:
    """The declarations of a function's parameters, without the first ``skipped`` ones."""
    hints = typing.get_type_hints(function, include_extras=True)
    parameters = list(inspect.signature(function).parameters.values())
    if len(parameters) < skipped:
        raise TypeError(f"{function.__name__} takes {skipped} arguments before its parameters")
    return [_param(one, hints.get(one.name), function) for one in parameters[skipped:]]


def _param(parameter: inspect.Parameter, hint: Any, function: Callable[..., Any]) -> dict[str, Any]:
    where = f"{function.__name__}: the parameter `{parameter.name}`"
    if parameter.kind in (parameter.VAR_POSITIONAL, parameter.VAR_KEYWORD):
        raise TypeError(f"{where} stands for several; a recipe needs each by its name")
    limits = Limits()
    if typing.get_origin(hint) is typing.Annotated:
        hint, *more = typing.get_args(hint)
        limits = next((one for one in more if isinstance(one, Limits)), limits)
    hint, optional = _without_none(hint)
    kind = _kind(hint, where)
    declared = {
        "name": parameter.name,
        "help": limits.help,
        "kind": kind,
        "default": _default(parameter, kind, optional, where),
        "above_min": limits.positive,
        "below_max": False,
        "nonzero": limits.nonzero,
        "example": "",
    }
    if limits != Limits(help=limits.help) and not _is_number(kind):
        raise TypeError(f"{where} is no number, and has no limits but its line of help")
    least = 0.0 if limits.positive or kind == "count" else None
    least = _number(limits.min, kind, where) if limits.min is not None else least
    if least is not None:
        declared["min"] = least
    if limits.max is not None:
        declared["max"] = _number(limits.max, kind, where)
    _refuse_default(declared, where)
    return declared


def _is_number(kind: Any) -> bool:
    return kind in ("number", "count") or (isinstance(kind, dict) and "quantity" in kind)


def _refuse_default(declared: dict[str, Any], where: str) -> None:
    """A default is held to the limits that a recipe's values are held to."""
    default = declared["default"]
    if not isinstance(default, dict) or "number" not in default:
        return
    number, least, most = default["number"], declared.get("min"), declared.get("max")
    low = least is not None and (number < least or (number == least and declared["above_min"]))
    high = most is not None and number > most
    if low or high or number != number or (number == 0 and declared["nonzero"]):
        raise ValueError(f"{where} has a default that its own limits do not allow")


def _without_none(hint: Any) -> tuple[Any, bool]:
    """An annotation without ``None``, and whether it had it."""
    parts = typing.get_args(hint)
    if type(None) in parts and len(parts) == 2:
        return next(part for part in parts if part is not type(None)), True
    return hint, False


def _kind(hint: Any, where: str) -> Any:
    if isinstance(hint, Kind):
        return {"quantity": hint.word}
    if typing.get_origin(hint) is typing.Literal:
        words = list(typing.get_args(hint))
        if not all(type(word) is str for word in words):
            raise TypeError(f"{where} has choices that are no texts: write typing.Literal['1', '2']")
        return {"choice": words}
    if hint in _PLAIN:
        return _PLAIN[hint]
    raise TypeError(
        f"{where} has no kind: annotate it with turnpath.Length or another quantity, float, int, "
        "bool, str, typing.Literal or turnpath.File"
    )


def _number(value: str | float, kind: Any, where: str) -> float:
    """A bound or a default as a number in mm, rad and s."""
    is_quantity = isinstance(kind, dict)
    if isinstance(value, str) != is_quantity or isinstance(value, bool):
        text = "is a quantity: write its limits as texts, such as '1 mm'"
        raise TypeError(f"{where} {text if is_quantity else 'has a limit that is no number'}")
    try:
        return _turnpath.parse_quantity(kind["quantity"], value) if is_quantity else float(value)
    except ValueError as error:
        raise ValueError(f"{where}: {error}") from None


def _default(parameter: inspect.Parameter, kind: Any, optional: bool, where: str) -> Any:
    value = parameter.default
    if value is parameter.empty:
        return "absent" if optional else "required"
    if value is None:
        return "absent"
    if isinstance(kind, dict) and "quantity" in kind:
        if not isinstance(value, str):
            raise TypeError(f"{where} needs a unit: write its default as a text, such as '1 mm'")
        return {"number": _number(value, kind, where)}
    if kind == "file":
        raise TypeError(f"{where} is a file, which has no default")
    words = kind["choice"] if isinstance(kind, dict) else None
    fits = {
        "number": isinstance(value, numbers.Real) and not isinstance(value, bool),
        "count": isinstance(value, numbers.Integral) and not isinstance(value, bool),
        "flag": isinstance(value, bool),
        "text": isinstance(value, str),
    }
    if value not in words if words is not None else not fits[kind]:
        told = f"one of {', '.join(words)}" if words is not None else f"a {kind}"
        raise TypeError(f"{where} has the default {value!r}, which is not {told}")
    if kind in ("number", "count"):
        return {"number": float(value)}
    return {"flag": value} if kind == "flag" else {"text": value}
