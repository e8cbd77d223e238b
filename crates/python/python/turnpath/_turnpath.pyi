"""The native part."""

from collections.abc import Callable, Sequence
from os import PathLike
from typing import Any, Literal, final

import numpy as np
from numpy.typing import ArrayLike, NDArray

_Column = NDArray[np.float64]
_Recipe = tuple[str, str, list[str]]
_File = str | PathLike[str]
_Sources = tuple[Sequence[dict[str, Any]], Sequence[_File]]

version: str

@final
class Control:
    def __new__(cls) -> Control: ...
    def cancel(self) -> None: ...
    def progress(self) -> tuple[str, int, int]: ...

@final
class Tool:
    @property
    def nose_radius(self) -> float:
        """Nose radius, mm."""
    @property
    def included_angle(self) -> float | None:
        """Included angle of the edge, rad; ``None`` for a full nose."""
    @property
    def clearance_angle(self) -> float | None:
        """Clearance angle below the edge, rad; ``None`` where the recipe gives none."""

@final
class Task:
    @property
    def aperture_radius(self) -> float:
        """Radius of the aperture, mm."""
    @property
    def inner_radius(self) -> float:
        """Radius of the hole, mm; 0 without one."""
    @property
    def nose_radius(self) -> float:
        """Nose radius, mm."""
    @property
    def tool(self) -> Tool: ...
    @property
    def interpolation(self) -> float:
        """Largest distance between the played and the true tool centre along z, mm."""
    @property
    def residual(self) -> float:
        """Largest cusp, mm."""
    @property
    def range(self) -> tuple[float, float]:
        """Smallest and largest ρ that the path covers, mm, overrun included."""
    @property
    def inward(self) -> bool:
        """Whether the tool feeds from the rim to the centre."""
    @property
    def spindle_speed(self) -> float:
        """The largest speed of the spindle, rad/s."""
    def limit(
        self,
        axis: Literal["X", "Z", "C"],
        derivative: Literal["velocity", "acceleration", "jerk"],
    ) -> float | None:
        """The machine's limit of an axis, in mm (rad for C) and s; ``None`` without a limit."""

@final
class Surface:
    def heights(self, x: ArrayLike, y: ArrayLike) -> _Column:
        """Heights, mm, at x and y, mm; shape (n,)."""
    def gradient(self, x: ArrayLike, y: ArrayLike) -> list[_Column]:
        """Heights, mm, and the slopes along x and y: three columns of shape (n,)."""

@final
class Locus:
    @property
    def radial(self) -> Literal["contact", "centre"]:
        """What ρ means: the radius of the contact, or x of the nose centre."""
    def centre(self, theta: ArrayLike, rho: ArrayLike) -> tuple[_Column, _Column, _Column]:
        """x and z of the nose centre and the radius of its contact, mm, for angles θ (rad) and radial
        parameters ρ (mm); shape (n,) each."""
    def series(self, theta: ArrayLike, rho: ArrayLike) -> tuple[_Column, _Column]:
        """The series of the nose centre's x and z along curves θ(t), ρ(t); all of shape (n, 5)."""
    def rates(self, theta: ArrayLike, rho: ArrayLike) -> list[_Column]:
        """∂X/∂θ and ∂X/∂ρ, then ∂Z/∂θ at constant X and ∂Z/∂X at constant θ; mm and rad, shape (n,)."""
    def residual_feed(self, residual: float, theta: ArrayLike, rho: ArrayLike) -> _Column:
        """The feed dρ/dN, mm, that leaves cusps of height ``residual``, mm; shape (n,)."""
    def heights(self, x: ArrayLike, y: ArrayLike) -> _Column:
        """Heights of the bare surface, mm, at x and y, mm; shape (n,)."""

@final
class Cut:
    @property
    def surface(self) -> Surface:
        """The surface to be cut."""
    @property
    def tool(self) -> Tool:
        """The tool."""

@final
class Setup:
    @property
    def task(self) -> Task: ...
    @property
    def locus(self) -> Locus: ...

@final
class Path:
    @property
    def task(self) -> Task: ...
    @property
    def locus(self) -> Locus: ...
    @property
    def end(self) -> float:
        """The revolutions of the law's end."""
    def radius_at(self, n: ArrayLike) -> _Column:
        """ρ, mm, after each of ``n`` revolutions; shape (n,)."""
    def time_at(self, n: ArrayLike) -> _Column:
        """The time, s, after each of ``n`` revolutions; shape (n,)."""
    def speed_at(self, n: ArrayLike) -> _Column:
        """The speed of the spindle, rad/s, after each of ``n`` revolutions; shape (n,)."""
    def knots(self, start: float, end: float) -> _Column:
        """The revolutions within (start, end) at which a piece of the law ends; shape (k,)."""
    def series_at(self, n: ArrayLike) -> tuple[_Column, _Column]:
        """The series in θ of the nose centre's x and z at each of ``n`` revolutions; shape (n, 5) each,
        in mm and rad."""

@final
class Block:
    @property
    def start(self) -> float:
        """The block's start in revolutions, included."""
    @property
    def end(self) -> float:
        """The block's end in revolutions, excluded."""
    def turns(self) -> list[tuple[float, float]]:
        """Start and end of each revolution; the path's last one may be a part of one."""

def parse_quantity(kind: str, text: str) -> float: ...
def subdivide(start: float, end: float, steps: float) -> _Column:
    """Nodes from ``start`` to ``end`` (excluded), in revolutions, 1/``steps`` of a revolution apart.
    ``steps`` is rounded up to a whole number. For less than 1 and for more than 10⁷ the only node is NaN, which
    is refused."""

def run(
    recipe: _Recipe,
    sources: _Sources,
    control: Control,
    *,
    folder: _File | None = None,
    map: tuple[_File, int] | None = None,
    threads: int = 0,
) -> tuple[str, list[_File], dict[str, NDArray[Any]] | None, list[tuple[str, bytes]]]: ...
def check(
    recipe: _Recipe, sources: _Sources, control: Control, *, threads: int = 0
) -> str: ...
def verify(
    recipe: _Recipe,
    sources: _Sources,
    control: Control,
    file: _File,
    *,
    map: tuple[_File, int] | None = None,
    threads: int = 0,
) -> str: ...
def ablate(
    recipe: _Recipe,
    sources: _Sources,
    control: Control,
    folder: _File,
    *,
    fresh: bool = False,
    threads: int = 0,
) -> tuple[str, list[_File], int]: ...
def plan(recipe: _Recipe, sources: _Sources, folder: _File) -> str: ...
def run_of(
    recipe: _Recipe, sources: _Sources, control: Control, folder: _File, key: str
) -> str: ...
def merge(
    recipe: _Recipe, sources: _Sources, control: Control, folder: _File
) -> tuple[str, list[_File], int]: ...
def strategies(sources: _Sources) -> list[tuple[str, str, str, str]]: ...
def main(arguments: list[str], sources: _Sources) -> int: ...
