"""Kinds of parameters. For a checker of types a quantity is anything: its default is a text with a
unit, and its value a number."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, TypeAlias

Length: TypeAlias = Any
Angle: TypeAlias = Any
PerLength: TypeAlias = Any
Feed: TypeAlias = Any
RotationSpeed: TypeAlias = Any
Frequency: TypeAlias = Any
Time: TypeAlias = Any
Velocity: TypeAlias = Any
Acceleration: TypeAlias = Any
Jerk: TypeAlias = Any
AngularAcceleration: TypeAlias = Any
AngularJerk: TypeAlias = Any
File: TypeAlias = bytes

@dataclass(frozen=True)
class Limits:
    min: str | float | None = None
    max: str | float | None = None
    positive: bool = False
    nonzero: bool = False
    help: str = ""

def declare(function: Callable[..., Any], skipped: int) -> list[dict[str, Any]]: ...
