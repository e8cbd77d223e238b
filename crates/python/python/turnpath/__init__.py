"""Tool paths for slow-tool-servo diamond turning, and strategies for them in Python.

>>> import turnpath
>>> result = turnpath.run("mirror.toml", set={"tolerance.residual": "50 nm"})  # doctest: +SKIP
>>> result.holds, result.toolpath.x.shape  # doctest: +SKIP

Lengths are in mm, angles in rad, times in s; ρ is the radius that the feed law controls, and N counts
revolutions. Interpreters without a global lock are not served.
"""

import sys as _sys

if not getattr(_sys, "_is_gil_enabled", lambda: True)():
    raise ImportError("turnpath does not serve free-threaded interpreters: start Python with its lock")

from ._ablation import Rows, ablate, merge, plan, run_of
from ._commands import (
    Judgement,
    Map,
    Report,
    Result,
    ToolPath,
    check,
    run,
    strategies,
    verify,
)
from ._errors import (
    Cancellation,
    Error,
    FileError,
    Interruption,
    Place,
    RecipeError,
    StrategyError,
    TimeLimit,
    TraceError,
)
from ._kinds import (
    Acceleration,
    Angle,
    AngularAcceleration,
    AngularJerk,
    Feed,
    File,
    Frequency,
    Jerk,
    Length,
    Limits,
    PerLength,
    RotationSpeed,
    Time,
    Velocity,
)
from ._laws import between
from ._recipe import Recipe
from ._strategies import (
    EntryPointWarning,
    Strategy,
    TraceWarning,
    compensator,
    feed,
    sampler,
    spindle,
    surface,
    velocity,
)
from ._turnpath import Block, Cut, Locus, Path, Setup, Surface, Task, subdivide
from ._turnpath import version as __version__

__all__ = [name for name in dir() if not name.startswith("_")]
