#!/usr/bin/env python3
"""Independent measurement of a turnpath `toolpath.csv` against its recipe.

Shares no code and no method with turnpath: surfaces are the textbook formulas (the off-axis
paraboloid is a rotated parent, solved for z), slopes come from complex steps, the first touch
from a dense scan of the nose and golden section, the residual from intersecting circles.

Lengths in mm, angles in rad unless a name ends in `_deg`; z towards the tool, material below.
A point of the part is (theta, rho), rho signed, with x = rho cos(theta), y = rho sin(theta).

    playback.py RECIPE.toml toolpath.csv [--stride N] [--instants M] [--sections S] [--scan P]

prints JSON: the error of interpolation (played minus true Z, along z), the residual (cusp
height along the profile's normal in the XZ plane, tool centres at their true Z), the highest cusp
as played, what stays
uncut at the part's edges and around the axis (null: not reached, or no such place), the error of
the machined surface (what the played nose leaves, along z), what a real nose leaves on the path of
a point, the form where the recipe has a tolerance of it, the rows of the file and the revolutions
of section 1. Only section 1 (cutting) is measured. Of recipes that
cut what fits, cusps count from the closing of the profile by the nose, and what stays between
closing and surface is a figure of its own.
"""

import argparse
import json
import math
import tomllib

import numpy as np

from surfaces import ANGLE_RAD, LENGTH_MM, quantity, surface

COLUMNS = "time_s,c_deg,x_mm,z_mm,vc_deg_per_s,vx_mm_per_s,vz_mm_per_s,section"
NM_PER_MM = 1e6
INSTANTS_PER_CHUNK = 24_000  # bounds memory, and keeps a chunk's arrays in the cache
SEAM_SCAN = 513
CLOSING_STEP = 2e-4  # mm: how far apart the nose is put on a section to see what it can reach
COMPENSATORS = ("z-direction", "normal", "none")

# --- recipe -------------------------------------------------------------------------------

class Recipe:
    """What a measurement needs of a recipe."""

    def __init__(self, table):
        part, tool = table["part"], table["tool"]
        self.part_radius = quantity(part, "aperture", LENGTH_MM) / 2
        self.hole_radius = quantity(part, "inner", LENGTH_MM, 0.0) / 2
        self.nose_radius = quantity(tool, "nose_radius", LENGTH_MM)
        included = quantity(tool, "included_angle", ANGLE_RAD, math.pi)
        self.nose_half_angle = min(included / 2, math.pi / 2)
        self.covers_axis = table.get("path", {}).get("overrun", "contact") != "none"
        self.cuts_what_fits = tool.get("interference", "refuse") == "cut-what-fits"
        self.asks_form = "form" in table.get("tolerance", {})
        self.covers_part = table.get("path", {}).get("overrun", "contact") == "contact"
        self.compensator = table["compensator"]["use"]
        if self.compensator not in COMPENSATORS:
            raise SystemExit(f"no reference for the compensator `{self.compensator}`")
        self.sag = surface(table)

    @property
    def leaves_seams(self):
        """Whether the nose may stand off the surface where it does not fit."""
        return self.cuts_what_fits and self.compensator != "none"

    @classmethod
    def read(cls, path):
        """The recipe in the TOML file `path`."""
        with open(path, "rb") as file:
            return cls(tomllib.load(file))

    def touch(self, theta, x, scan):
        """`first_touch` on this recipe."""
        return first_touch(self, theta, x, scan)

    def has_radius(self, rho):
        """Whether the part reaches over the radius rho, of either sign."""
        return (np.abs(rho) <= self.part_radius) & (np.abs(rho) >= self.hole_radius)

    def profile(self, theta):
        """The radial profile at theta: a function of rho, scalar, array or complex."""
        cos, sin = np.cos(theta), np.sin(theta)
        return lambda rho: self.sag(rho * cos, rho * sin)


def slope(profile, rho):
    """g_rho by a complex step: exact to rounding."""
    return np.imag(profile(rho + 1e-30j)) / 1e-30


# --- the true tool centre -----------------------------------------------------------------

def first_touch(recipe, theta, x, scan=129):
    """Z of the nose centre at (theta, x) when the nose, coming down, first touches the profile.

    max over phi of g(theta, x + R sin phi) + R cos phi, phi within half the included angle:
    a scan of `scan` angles picks the highest hill (by the parabola through its top three),
    golden section climbs it.
    """
    profile, radius = recipe.profile(theta), recipe.nose_radius
    angles = np.linspace(-recipe.nose_half_angle, recipe.nose_half_angle, scan)

    def height(phi):
        z = profile(x + radius * np.sin(phi)) + radius * np.cos(phi)
        return np.where(np.isnan(z), -np.inf, z)

    with np.errstate(invalid="ignore"):  # a formula may end within the nose's reach
        hill = highest_hill(height, angles)
        step = angles[1] - angles[0]
        return climb(height, np.maximum(hill - step, angles[0]), np.minimum(hill + step, angles[-1]))


def highest_hill(height, angles):
    """The scanned angle at the top of the highest hill, per element."""
    left, top = height(angles[0]), height(angles[1])
    best, where = left, np.full(np.shape(left), angles[0])
    for i in range(1, len(angles)):
        right = height(angles[i + 1]) if i + 1 < len(angles) else np.full_like(top, -np.inf)
        bend = 2 * top - left - right
        is_hill = (top >= left) & (top >= right) & (bend > 0) & np.isfinite(bend)
        rise = np.where(is_hill, (right - left) ** 2 / (8 * np.where(is_hill, bend, 1)), 0)
        better = top + rise > best
        best, where = np.where(better, top + rise, best), np.where(better, angles[i], where)
        left, top = top, right
    return where


def climb(height, low, high, rounds=32):
    """The maximum of `height` on [low, high] by golden section, per element.

    32 rounds shrink the bracket 5e6 times; the height errs by the square of that.
    """
    golden = (math.sqrt(5) - 1) / 2
    a, b = high - golden * (high - low), low + golden * (high - low)
    at_a, at_b = height(a), height(b)
    for _ in range(rounds):
        keep_low = at_a > at_b
        low, high = np.where(keep_low, low, a), np.where(keep_low, b, high)
        new = np.where(keep_low, high - golden * (high - low), low + golden * (high - low))
        at_new = height(new)
        a, b = np.where(keep_low, new, b), np.where(keep_low, a, new)
        at_a, at_b = np.where(keep_low, at_new, at_b), np.where(keep_low, at_a, at_new)
    ends = np.maximum(height(low), height(high))
    return np.maximum(np.maximum(at_a, at_b), ends)


def true_z(recipe, theta, x, scan):
    """What the path's Z should be: the first touch, or the surface for the compensator `none`."""
    if recipe.compensator == "none":
        return recipe.profile(theta)(x)
    return recipe.touch(theta, x, scan)


# --- the played path ----------------------------------------------------------------------

class ToolPath:
    """Section 1 of a path: a cubic Hermite in time per axis between rows."""

    AXES = {"c": (1, 4), "x": (2, 5), "z": (3, 6)}  # columns of position and velocity

    def __init__(self, rows):
        self.rows = len(rows)
        cutting = np.flatnonzero(rows[:, 7] == 1)
        if len(cutting) < 2 or np.any(np.diff(cutting) != 1):
            raise SystemExit("section 1 must be one run of two rows or more")
        self.nodes = rows[cutting[0]:cutting[-1] + 1]
        self.durations = np.diff(self.nodes[:, 0])
        if not (np.all(np.isfinite(self.nodes)) and np.all(self.durations > 0)):
            raise SystemExit("rows must be finite and time must increase")
        self.segments = len(self.durations)
        self.revolutions = (self.nodes[-1, 1] - self.nodes[0, 1]) / 360

    @classmethod
    def read(cls, path):
        """The path in the CSV file `path`."""
        with open(path, encoding="utf-8") as file:
            if file.readline().strip() != COLUMNS:
                raise SystemExit(f"{path}: the header is not `{COLUMNS}`")
            return cls(np.loadtxt(file, delimiter=",", ndmin=2))

    def play(self, axis, segment, tau):
        """Position of an axis at the fraction `tau` of the segments (deg or mm)."""
        p, v = self.AXES[axis]
        h = self.durations[segment]
        start, end = self.nodes[segment, p], self.nodes[segment + 1, p]
        from_start = self.nodes[segment, v] * h
        from_end = self.nodes[segment + 1, v] * h
        chord, rest = end - start, 1 - tau
        return (start + chord * tau * tau * (3 - 2 * tau)
                + tau * rest * (from_start * rest - from_end * tau))

    def pass_x(self, target_deg):
        """X as played where C passes `target_deg` (increasing C), by bisection."""
        return self.play("x", *self.when(target_deg))

    def when(self, target_deg):
        """Segment and fraction at which C passes `target_deg` (increasing C), by bisection."""
        segment = np.searchsorted(self.nodes[:, 1], target_deg, side="right") - 1
        segment = np.clip(segment, 0, self.segments - 1)
        low, high = np.zeros(len(target_deg)), np.ones(len(target_deg))
        for _ in range(54):
            middle = (low + high) / 2
            before = self.play("c", segment, middle) < target_deg
            low, high = np.where(before, middle, low), np.where(before, high, middle)
        return segment, (low + high) / 2


# --- measurements -------------------------------------------------------------------------

def radians(degrees):
    """Unwrapped degrees to radians within one turn, without loss at many turns."""
    return np.radians(np.fmod(degrees, 360.0))


def interpolation_error(recipe, path, stride=1, instants=48, scan=129):
    """Played minus true Z at `instants` steps a segment: extremes, time-weighted RMS, place."""
    instants += instants % 2  # the midpoint is among them, and Simpson's rule needs it even
    tau = np.arange(instants + 1) / instants
    simpson = np.where(np.arange(instants + 1) % 2 == 1, 4.0, 2.0)
    simpson[[0, -1]] = 1.0
    simpson /= 3 * instants
    chosen = np.arange(0, path.segments, stride)
    chunk = max(1, INSTANTS_PER_CHUNK // len(tau))
    low, high, worst, at = math.inf, -math.inf, -1.0, None
    squares = duration = 0.0
    for first in range(0, len(chosen), chunk):
        segment = chosen[first:first + chunk, None]
        c_deg, x = path.play("c", segment, tau), path.play("x", segment, tau)
        error = path.play("z", segment, tau) - true_z(recipe, radians(c_deg), x, scan)
        low, high = min(low, error.min()), max(high, error.max())
        place = np.unravel_index(np.argmax(np.abs(error)), error.shape)
        if abs(error[place]) > worst:
            worst, at = abs(error[place]), {"c_deg": float(c_deg[place]), "x_mm": float(x[place])}
        if recipe.cuts_what_fits:
            worst, at, low, high = sharpen(recipe, path, segment[:, 0], error, scan, (worst, at, low, high))
        h = path.durations[segment[:, 0]]
        squares += float(h @ (error**2 @ simpson))
        duration += float(h.sum())
    return {"max": float(worst * NM_PER_MM), "rms": math.sqrt(squares / duration) * NM_PER_MM,
            "lowest": float(low * NM_PER_MM), "highest": float(high * NM_PER_MM), "at": at}


def sharpen(recipe, path, segment, error, scan, known, worst_segments=40, instants=1500):
    """The extremes so far, with the worst segments of a chunk played back more finely: where the
    contact jumps over a seam the error has a corner."""
    worst, at, low, high = known
    chosen = segment[np.argsort(np.abs(error).max(axis=1))[-worst_segments:]]
    tau = np.arange(instants + 1) / instants
    for one in chosen:
        one = np.array([one])[:, None]
        c_deg, x = path.play("c", one, tau)[0], path.play("x", one, tau)[0]
        fine = path.play("z", one, tau)[0] - true_z(recipe, radians(c_deg), x, scan)
        low, high = min(low, fine.min()), max(high, fine.max())
        k = int(np.argmax(np.abs(fine)))
        if abs(fine[k]) > worst:
            worst, at = abs(fine[k]), {"c_deg": float(c_deg[k]), "x_mm": float(x[k])}
    return worst, at, low, high


def nose_centres(recipe, theta, x, scan):
    """True nose centres (X, Z) of passes whose played X is `x`."""
    if recipe.compensator != "none":
        return x, recipe.touch(theta, x, scan)
    profile, radius = recipe.profile(theta), recipe.nose_radius
    g, s = profile(x), slope(profile, x)
    w = np.sqrt(1 + s * s)
    return x - radius * s / w, g + radius / w


def cusps(recipe, x, z):
    """The highest places that neighbouring noses at (x, z) leave between them: where their circles
    cross, or where the edge of one ends before that, the other's circle there."""
    radius, reach = recipe.nose_radius, recipe.nose_radius * math.sin(recipe.nose_half_angle)
    cusp_x, cusp_z = lower_intersection(radius, x, z)
    lower, upper = np.minimum(x[1:], x[:-1]), np.maximum(x[1:], x[:-1])
    at = np.clip(cusp_x, upper - reach, lower + reach)
    sides = [c - np.sqrt(np.maximum(radius**2 - (at - a)**2, 0)) for a, c in ((x[1:], z[1:]), (x[:-1], z[:-1]))]
    return at, np.where(at == cusp_x, cusp_z, np.maximum(*sides))


def lower_intersection(radius, x, z):
    """Lower intersections of neighbouring circles of one radius."""
    dx, dz = np.diff(x), np.diff(z)
    apart = np.hypot(dx, dz)
    drop = np.sqrt(np.maximum(radius**2 - apart**2 / 4, 0)) / apart
    up = np.sign(dx)  # makes the chord's normal (-dz, dx) point up
    return (x[:-1] + x[1:]) / 2 + up * dz * drop, (z[:-1] + z[1:]) / 2 - up * dx * drop


def height_above(profile, x, z):
    """Distance of points from the profile along its normal (above: positive), and the feet."""
    foot = x
    for _ in range(12):  # Gauss-Newton; each round gains a factor height times curvature
        s = slope(profile, foot)
        foot = foot + (x - foot + (z - profile(foot)) * s) / (1 + s * s)
    s = slope(profile, foot)
    return ((z - profile(foot)) - s * (x - foot)) / np.sqrt(1 + s * s), foot


def closing_at(recipe, theta, s, low, high, scan):
    """The lowest that the nose can leave over the places `s`, and the X between low and high where
    it stands then.

    That is the least over X of the lower side of the nose at X: one valley, found by golden section.
    """
    radius = recipe.nose_radius

    def under(at):
        side = np.sqrt(np.maximum(radius**2 - (at - s)**2, 0))
        return recipe.touch(theta, at, scan) - side

    golden = (math.sqrt(5) - 1) / 2
    a, b = high - golden * (high - low), low + golden * (high - low)
    at_a, at_b = under(a), under(b)
    for _ in range(40):
        left = at_a < at_b
        low, high = np.where(left, low, a), np.where(left, b, high)
        new = np.where(left, high - golden * (high - low), low + golden * (high - low))
        at_new = under(new)
        a, b = np.where(left, new, b), np.where(left, a, new)
        at_a, at_b = np.where(left, at_new, at_b), np.where(left, at_a, at_new)
    return np.minimum(at_a, at_b), np.where(at_a < at_b, a, b)


def height_above_closing(recipe, theta, x, z, first, second, scan):
    """Distance of cusps at (x, z) from the lowest that the nose can leave there, along the normal.

    The nose that leaves it stands between the two passes. The normal is that of the surface where
    the nose touches it there, else that of the nose.
    """
    profile, radius = recipe.profile(theta), recipe.nose_radius
    low, high = np.minimum(first, second), np.maximum(first, second)
    closing, at = closing_at(recipe, theta, x, low, high, scan)
    touches = closing - profile(x) < 1e-8
    side = np.sqrt(np.maximum(radius**2 - (at - x)**2, 0))
    normal = np.where(touches, 1 / np.sqrt(1 + slope(profile, x)**2), side / radius)
    return (z - closing) * normal


def section_residual(recipe, path, section_deg, scan):
    """The highest cusp at one section angle and its place; (-inf, None) where there is none.

    Left out: pairs of passes on both sides of the axis (the innermost turn), passes that
    repeat one X, and cusps off the part. A cusp is on the part if its tip or its foot is: on a steep
    wall the foot of a tip over the part may lie beyond the rim.
    """
    first = math.ceil((path.nodes[0, 1] - section_deg) / 360)
    last = math.floor((path.nodes[-1, 1] - section_deg) / 360)
    played = path.pass_x(section_deg + 360.0 * np.arange(first, last + 1))
    theta = math.radians(section_deg)
    with np.errstate(invalid="ignore", divide="ignore"):  # a formula may end beyond the part
        x, z = nose_centres(recipe, theta, played, scan)
        cusp_x, cusp_z = cusps(recipe, x, z)
        index = np.flatnonzero((played[1:] * played[:-1] > -1e-12) & (np.abs(np.diff(x)) > 1e-9))
        if recipe.leaves_seams:
            foot = cusp_x[index]
            height = height_above_closing(recipe, theta, foot, cusp_z[index], x[index],
                                          x[index + 1], scan)
        else:
            height, foot = height_above(recipe.profile(theta), cusp_x[index], cusp_z[index])
    if np.any(np.isnan(height) & (np.abs(cusp_x[index]) <= recipe.part_radius)):
        raise SystemExit(f"a pass or its cusp at C = {section_deg} deg leaves the surface's domain")
    on_part = recipe.has_radius(foot) | (recipe.has_radius(cusp_x[index]) & np.isfinite(height))
    if not np.any(on_part):
        return -math.inf, None
    height, foot = height[on_part], foot[on_part]
    k = int(np.argmax(height))
    return float(height[k]), {"c_deg": section_deg, "x_mm": float(foot[k])}


def residual(recipe, path, sections=90, scan=129):
    """The highest cusp over `sections` angles, then over 20 finer ones around the worst. Beside a seam
    cusps change fast with the angle, so finer ones are put around the worst few.

    "at" is the section angle (within one turn) and the cusp's foot on the profile.
    """
    step = 360 / sections
    coarse = [section_residual(recipe, path, (i + 0.37) * step, scan) for i in range(sections)]
    worst = max(coarse, key=lambda found: found[0])
    if worst[1] is None:
        return {"max": None, "at": None}
    found = sorted((one for one in coarse if one[1]), key=lambda one: -one[0])
    around = [one[1]["c_deg"] + step * np.arange(-10, 11) / 10
              for one in found[:ZOOMED if recipe.leaves_seams else 1]]
    fine = [section_residual(recipe, path, float(c), scan) for c in np.concatenate(around)]
    worst = max([worst, *fine], key=lambda found: found[0])
    return {"max": worst[0] * NM_PER_MM, "at": worst[1]}


class Sections:
    """X as played just behind every degree, a turn in each place. At the axis the height goes up
    and down between cusp and pass with the angle, so turnpath's own sections are the ones to take;
    on a degree itself a point where the path begins or ends would count or not by rounding."""

    COUNT = 360

    def __init__(self, recipe, path, scan):
        self.recipe, self.path, self.scan = recipe, path, scan
        self.degrees = np.arange(self.COUNT) * 360 / self.COUNT + 1e-7
        self.played = [self.turns(path, c) for c in self.degrees]

    @staticmethod
    def turns(path, section_deg):
        """X of every pass of one section, in the order of time."""
        first = math.ceil((path.nodes[0, 1] - section_deg) / 360)
        last = math.floor((path.nodes[-1, 1] - section_deg) / 360)
        return path.pass_x(section_deg + 360.0 * np.arange(first, last + 1))

    def line(self, i, chosen):
        """True nose centres (x, z) along the line of section i: its own passes, and those of the
        opposite half mirrored. `chosen` takes the passes' X and gives the ones that count."""
        j = (i + self.COUNT // 2) % self.COUNT
        sides = ((self.degrees[k], self.played[k]) for k in (i, j))
        return self.centres(sides, chosen)

    def line_at(self, degrees, chosen):
        """The same at any angle."""
        sides = ((c, self.turns(self.path, c)) for c in (degrees, (degrees + 180) % 360))
        return self.centres(sides, chosen)

    def centres(self, sides, chosen):
        """True nose centres of the passes of both sides of a line."""
        found = []
        for (degrees, played), sign in zip(sides, (1.0, -1.0)):
            played = chosen(played, sign)
            theta = math.radians(degrees)
            with np.errstate(invalid="ignore"):
                x, z = nose_centres(self.recipe, theta, played, self.scan)
            found.append((sign * x, z))
        return found


def uncut_at(sections, radius, degrees):
    """What the nose leaves of the wanted surface at `radius` and an angle: the distance from the
    nearest cut, or the height along the normal of the lowest that is cut at that radius, whichever
    is larger; infinite where the nose stands above it nowhere. Over a seam it is the distance from
    the best that the nose can cut."""
    recipe = sections.recipe
    nose, reach = recipe.nose_radius, recipe.nose_radius * math.sin(recipe.nose_half_angle)
    near = lambda x, sign: x[np.abs(sign * x - radius) < 2 * nose]
    theta = math.radians(degrees)
    profile = recipe.profile(theta)
    place, seam = float(profile(np.float64(radius))), 0.0
    if recipe.leaves_seams:
        at = np.array([radius])
        seam = float(closing_at(recipe, theta, at, at - reach, at + reach, sections.scan)[0][0]) - place
    uncut = lowest = math.inf
    for x, z in sections.line_at(degrees, near):
        over = np.abs(x - radius) < reach
        x, z = x[over], z[over]
        away = np.hypot(x - radius, z - place - seam)
        uncut = min(uncut, away.min(initial=math.inf) - nose)
        lowest = min(lowest, np.min(z - np.sqrt(nose**2 - (x - radius)**2), initial=math.inf))
    if math.isinf(lowest) or seam > 1e-6:
        return uncut
    with np.errstate(invalid="ignore", divide="ignore"):
        height, _ = height_above(profile, np.array([radius]), np.array([lowest]))
    if not np.isfinite(height[0]):  # the surface ends before the foot
        height = (lowest - place) / np.sqrt(1 + slope(profile, np.array([radius]))**2)
    return max(uncut, float(height[0]))


def uncut_at_edge(sections, radius):
    """The largest of `uncut_at` over all angles: over every degree, beside the path's ends, where
    it jumps, and ever more finely around the largest."""
    path = sections.path
    angles = list(sections.degrees)
    angles += [float(np.fmod(path.nodes[end, 1] + off, 360)) % 360 for end in (0, -1) for off in (-1e-7, 1e-7)]
    height = lambda degrees: uncut_at(sections, radius, degrees)
    heights = [height(degrees) for degrees in angles]
    worst = max(heights)
    at, step = angles[heights.index(worst)], 0.25
    while step > 1e-5 and math.isfinite(worst):
        around = [(height(at + k * step), at + k * step) for k in range(-4, 5)]
        worst, at = max([(worst, at), *around])
        step /= 4
    return worst


def uncut_at_centre(sections):
    """The highest cusp between neighbouring passes of the innermost three turns, both halves of
    each line together; infinite where they do not meet, or one half has none. Over a seam through
    the axis it counts from the lowest that the nose can leave."""
    recipe, worst = sections.recipe, -math.inf
    played = [x for x in sections.played if len(x)]
    ends = [abs(np.mean([x[at] for x in played])) for at in (0, -1)]
    innermost = (lambda x, _: x[:3]) if ends[0] < ends[1] else (lambda x, _: x[-3:])
    for i in range(sections.COUNT // 2):
        sides = sections.line(i, innermost)
        if any(len(x) == 0 for x, _ in sides):
            return math.inf
        x, z = (np.concatenate(both) for both in zip(*sides))
        order = np.argsort(x)
        x, z = x[order], z[order]
        apart = np.hypot(np.diff(x), np.diff(z))
        if np.any(apart > 2 * recipe.nose_radius):
            return math.inf
        with np.errstate(invalid="ignore", divide="ignore"):
            cusp_x, cusp_z = lower_intersection(recipe.nose_radius, x, z)
        differ = apart > 1e-9
        theta = math.radians(sections.degrees[i])
        if recipe.leaves_seams:
            foot = cusp_x[differ]
            height = height_above_closing(recipe, theta, foot, cusp_z[differ], x[:-1][differ],
                                          x[1:][differ], sections.scan)
        else:
            height, foot = height_above(recipe.profile(theta), cusp_x[differ], cusp_z[differ])
        on_part = np.abs(foot) <= recipe.part_radius
        worst = max(worst, height[on_part].max(initial=-math.inf))
    return worst if worst > -math.inf else math.inf


def coverage(recipe, path, scan=129):
    """What stays uncut at the rim, at the hole or around the axis."""
    sections = Sections(recipe, path, scan)
    heights = {"rim": uncut_at_edge(sections, recipe.part_radius), "hole": None, "centre": None}
    if recipe.hole_radius > 0:
        heights["hole"] = uncut_at_edge(sections, recipe.hole_radius)
    else:
        heights["centre"] = uncut_at_centre(sections)
    return {place: None if height is None or math.isinf(height) else float(height * NM_PER_MM)
            for place, height in heights.items()}


# --- cusps as played ----------------------------------------------------------------------

def section_played_cusp(recipe, path, section_deg, scan):
    """The highest cusp on the line at an angle, of the noses as played; -inf without one.

    A nose that is played too high may cut nothing: such ones are dropped until every nose cuts
    between its neighbours. Where the path is not meant to cover the axis, the cusp between its two
    sides is left out.
    """
    x, z, own = played_circles(recipe, path, section_deg, with_side=True)
    kept, tips = [], []
    for i in range(len(x)):
        while kept:
            pair = [kept[-1], i]
            tip, _ = cusps(recipe, x[pair], z[pair])
            if x[i] == x[kept[-1]]:
                tip[0] = -math.inf if z[i] < z[kept[-1]] else math.inf
            if not tips or tip[0] > tips[-1]:
                break
            kept.pop()
            tips.pop()
        if kept:
            if tip[0] == math.inf:
                continue
            if tip[0] == -math.inf:
                kept.pop()
            else:
                tips.append(float(tip[0]))
        kept.append(i)
    kept = np.array(kept)
    cusp_x, cusp_z = cusps(recipe, x[kept], z[kept])
    chosen = (np.abs(cusp_x) <= recipe.part_radius) & (np.abs(cusp_x) >= recipe.hole_radius)
    chosen &= np.hypot(np.diff(x[kept]), np.diff(z[kept])) > 1e-9
    if not recipe.covers_axis:
        chosen &= own[kept][1:] == own[kept][:-1]
    if not np.any(chosen):
        return -math.inf
    if recipe.leaves_seams:
        first, second = x[kept][:-1][chosen], x[kept][1:][chosen]
        heights = height_above_closing(recipe, math.radians(section_deg), cusp_x[chosen],
                                       cusp_z[chosen], first, second, scan)
    else:
        profile = recipe.profile(math.radians(section_deg))
        heights, _ = height_above(profile, cusp_x[chosen], cusp_z[chosen])
    return float(np.max(heights))


def played_cusp(recipe, path, sections=180, scan=129):
    """The highest cusp of the path as played, over lines through the axis, and over finer ones
    around the worst."""
    step = 180 / sections
    at = [(i + 0.29) * step for i in range(sections)]
    heights = [section_played_cusp(recipe, path, degrees, scan) for degrees in at]
    worst = at[int(np.argmax(heights))]
    fine = [section_played_cusp(recipe, path, worst + step * k / 6, scan) for k in range(-6, 7)]
    highest = max(heights + fine)
    return {"max": None if math.isinf(highest) else highest * NM_PER_MM}


# --- what the nose cannot reach -----------------------------------------------------------

def section_closing(recipe, theta, step):
    """Places from rim to rim a `step` apart, and how far the closing of the section by the nose lies
    above it there: the nose is put on the section at every place, and the lowest of all kept."""
    radius, rim = recipe.nose_radius, recipe.part_radius
    profile = recipe.profile(theta)
    sample = np.linspace(-rim - radius, rim + radius, 4001)
    steepest = np.abs(slope(profile, sample)).max() * 1.05
    reach = radius * min(steepest / math.hypot(1, steepest), math.sin(recipe.nose_half_angle))
    arm = math.ceil(reach / step)
    inside = math.ceil(rim / step)
    places = step * np.arange(-inside - 2 * arm, inside + 2 * arm + 1)
    section = profile(places)
    offsets = np.arange(-arm, arm + 1)
    lift = np.sqrt(radius**2 - (step * offsets)**2)
    centres = np.full(len(places) - 2 * arm, -np.inf)
    for k, up in zip(offsets, lift):
        np.maximum(centres, section[arm + k:arm + k + len(centres)] + up, out=centres)
    closing = np.full(len(centres) - 2 * arm, np.inf)
    for k, up in zip(offsets, lift):
        np.minimum(closing, centres[arm + k:arm + k + len(closing)] - up, out=closing)
    return places[2 * arm:-2 * arm], closing - section[2 * arm:-2 * arm]


def unreached(recipe, sections=180, step=CLOSING_STEP):
    """Largest height (along z) and volume between the surface and its closing by the nose.

    Putting the nose at steps of X misses the lowest place over a seam by a part of the step: the
    volume is extrapolated from two steps, the highest section made again with a finer one.
    """
    if not recipe.leaves_seams:
        return None
    volumes, sections_heights = [], []
    thetas = math.pi * (np.arange(sections) + 0.37) / sections
    for width in (2 * step, step):
        volume, heights = 0.0, []
        for theta in thetas:
            rho, height = section_closing(recipe, theta, width)
            on_part = (np.abs(rho) <= recipe.part_radius) & (np.abs(rho) >= recipe.hole_radius)
            volume += math.pi / sections * width * float(np.sum((height * np.abs(rho))[on_part]))
            heights.append(float(height[on_part].max()))
        volumes.append(volume)
        sections_heights.append(heights)
    low, high = thetas[np.argmax(sections_heights[-1])] + math.pi / sections * np.array([-1, 1])
    highest = 0.0
    for theta in np.linspace(low, high, 9):
        rho, height = section_closing(recipe, theta, step / 5)
        on_part = (np.abs(rho) <= recipe.part_radius) & (np.abs(rho) >= recipe.hole_radius)
        highest = max(highest, float(height[on_part].max()))
    return {"height_um": highest * 1e3, "volume_mm3": 2 * volumes[1] - volumes[0]}


# --- the machined surface -----------------------------------------------------------------

NEIGHBOURS = 12     # passes to either side of a place that may cut it, where the nose fits
PLACES_A_PASS = 8   # places of the grid for each pass, along a line through the axis
FEWEST_PLACES = 2000
ZOOMED = 8          # lines around which the highest and the lowest place are looked for again


def played_circles(recipe, path, section_deg, with_side=False, real=False):
    """Nose centres (signed place, Z) on the line through the axis at an angle, as played, and
    which side of the axis their X belongs to, if that is asked.

    The path of the compensator `none` is that of a point. Its nose touches the surface at each
    point, or has its lowest point there if it is a `real` one."""
    places, heights, sides = [], [], []
    for turned, sign in ((0.0, 1.0), (180.0, -1.0)):
        section = section_deg + turned
        first = math.ceil((path.nodes[0, 1] - section) / 360)
        last = math.floor((path.nodes[-1, 1] - section) / 360)
        when = path.when(section + 360.0 * np.arange(first, last + 1))
        x, z = path.play("x", *when), path.play("z", *when)
        sides.append(sign * np.where(x < 0, -1.0, 1.0))
        if recipe.compensator == "none" and real:
            z = z + recipe.nose_radius
        elif recipe.compensator == "none":
            tilt = slope(recipe.profile(math.radians(section)), x)
            w = np.sqrt(1 + tilt * tilt)
            x, z = x - recipe.nose_radius * tilt / w, z + recipe.nose_radius / w
        places.append(sign * x)
        heights.append(z)
    places, heights = np.concatenate(places), np.concatenate(heights)
    order = np.argsort(places, kind="stable")
    if with_side:
        return places[order], heights[order], np.concatenate(sides)[order]
    return places[order], heights[order]


def line_error(recipe, path, section_deg, s, real=False):
    """Machined minus wanted at the places `s` of a line: the minimum over circles near where the
    nose would touch each place; infinite where none reaches."""
    x, z = played_circles(recipe, path, section_deg, real=real)
    profile, radius = recipe.profile(math.radians(section_deg)), recipe.nose_radius
    tilt = slope(profile, s)
    touching = s - radius * tilt / np.sqrt(1 + tilt * tilt)
    nearest = np.searchsorted(x, touching)
    reach = radius * math.sin(recipe.nose_half_angle)
    lowest = np.full(len(s), np.inf)
    neighbours = NEIGHBOURS
    if recipe.cuts_what_fits or real:  # over a seam any pass within reach may be the lowest
        neighbours += int(2 * reach * len(x) / (x[-1] - x[0]))
    for step in range(-neighbours, neighbours):
        index = nearest + step
        there = (index >= 0) & (index < len(x))
        index = np.clip(index, 0, len(x) - 1)
        off = s - x[index]
        depth = np.sqrt(np.maximum(radius**2 - off * off, 0))
        cut = np.where(there & (np.abs(off) <= reach), z[index] - depth, np.inf)
        lowest = np.minimum(lowest, cut)
    return lowest - profile(s)


def line_places(recipe, count, shift):
    """`count` signed places on the part with the edges; `shift` of a step from line to line."""
    half = max(count, FEWEST_PLACES) // 2
    ring = recipe.part_radius - recipe.hole_radius
    inner = recipe.hole_radius + ring * (np.arange(half) + shift) / half
    side = np.concatenate([[recipe.hole_radius], inner, [recipe.part_radius]])
    return np.concatenate([-side[::-1], side])


def surface_error(recipe, path, sections=None, real=False):
    """PV and RMS of machined minus wanted along z, on a polar grid; the RMS weighted by area.

    PV is looked for again around the extremes of the grid, in angle and along the line.
    """
    passes = 2 * path.revolutions
    sections = sections or (240 if passes < 4000 else 48)
    step = 180 / sections
    area = squares = 0.0
    found = []
    for i in range(sections):
        angle = (i + 0.41) * step
        s = line_places(recipe, int(PLACES_A_PASS * passes), (0.5 + 0.618 * i) % 1.0)
        error = line_error(recipe, path, angle, s, real)
        weight = np.where(np.isfinite(error), np.abs(s), 0.0)
        weight[np.abs(s) == recipe.part_radius] = 0.0  # an edge is no part of the area
        weight[np.abs(s) == recipe.hole_radius] = 0.0
        area += weight.sum()
        squares += float(weight @ np.where(weight > 0, error, 0.0) ** 2)
        cut = np.where(np.isfinite(error), error, np.nan)
        high, low = int(np.nanargmax(cut)), int(np.nanargmin(cut))
        found.append((angle, s[high], cut[high], s[low], cut[low]))
    pitch = 2 * recipe.part_radius / passes
    error_at = lambda angle, s: line_error(recipe, path, angle, s, real)
    highest = max(zoom(recipe, error_at, angle, s, step, pitch, np.nanmax)
                  for angle, s, _, _, _ in sorted(found, key=lambda one: -one[2])[:ZOOMED])
    lowest = min(zoom(recipe, error_at, angle, s, step, pitch, np.nanmin)
                 for angle, _, _, s, _ in sorted(found, key=lambda one: one[4])[:ZOOMED])
    return {"pv": (highest - lowest) * NM_PER_MM, "highest": highest * NM_PER_MM,
            "lowest": lowest * NM_PER_MM, "rms": math.sqrt(squares / area) * NM_PER_MM}


def zoom(recipe, error_at, angle, s, step, pitch, extreme):
    """The extreme error within a section's width and three passes of a place."""
    s = s + pitch * np.linspace(-3, 3, 1201)
    s = np.clip(s, -recipe.part_radius, recipe.part_radius)
    s = s[np.abs(s) >= recipe.hole_radius]
    errors = [error_at(angle + step * share, s) for share in np.linspace(-0.5, 0.5, 41)]
    errors = np.array(errors)
    return float(extreme(np.where(np.isfinite(errors), errors, np.nan)))


def real_nose(recipe, path):
    """PV of what a real nose leaves on the path of the compensator `none`; None on any other."""
    if recipe.compensator != "none":
        return None
    found = surface_error(recipe, path, real=True)
    return {key: found[key] for key in ("pv", "highest", "lowest")}


FORM_SECTIONS = 240
SEAM_PLACES = 5e-4  # mm: how far apart places are where a line with seams is looked over
SEAM_ZOOMED = 3     # lines around which its highest and its lowest place are looked for again


def form_error(recipe, path, surface, scan=129):
    """PV of the machined surface as its tolerance counts it, None unless the recipe asks.

    It is that of `surface`, the figures of the machined surface, which of the compensator `none` is
    what a real nose leaves. Where the nose leaves seams it counts from the closing of each section
    by the nose; where the path does not cover the part, between the contacts of the outermost and
    of the innermost passes of either side.
    """
    if not recipe.asks_form:
        return None
    if recipe.covers_part and not recipe.leaves_seams:
        return surface["pv"]
    real, step = recipe.compensator == "none", 180 / FORM_SECTIONS
    found = []
    for i in range(FORM_SECTIONS):
        angle, closing = (i + 0.41) * step, 0.0
        if recipe.leaves_seams:
            s, closing = section_closing(recipe, math.radians(angle), SEAM_PLACES)
        else:
            s = line_places(recipe, int(4 * PLACES_A_PASS * path.revolutions), (0.618 * i) % 1.0)
        error = line_error(recipe, path, angle, s, real) - closing
        error = np.where(counts_for_form(recipe, path, angle, s), error, np.nan)
        high, low = int(np.nanargmax(error)), int(np.nanargmin(error))
        found.append((angle, s[high], error[high], s[low], error[low]))
    by_height, by_depth = sorted(found, key=lambda one: -one[2]), sorted(found, key=lambda one: one[4])
    if not recipe.leaves_seams:
        return float((by_height[0][2] - by_depth[0][4]) * NM_PER_MM)
    pitch = recipe.part_radius / path.revolutions
    highest = max(zoom_over_closing(recipe, path, angle, s, step, pitch, 1, scan)
                  for angle, s, _, _, _ in by_height[:SEAM_ZOOMED])
    depth = max(zoom_over_closing(recipe, path, angle, s, step, pitch, -1, scan)
                for angle, _, _, s, _ in by_depth[:SEAM_ZOOMED])
    return float((highest + depth) * NM_PER_MM)


def counts_for_form(recipe, path, angle, s):
    """Which places of a line its form counts."""
    counts = recipe.has_radius(s)
    if recipe.covers_part:
        return counts
    x, _ = played_circles(recipe, path, angle, real=recipe.compensator == "none")
    left, right = x[x < 0], x[x >= 0]
    return counts & (between_contacts(recipe, angle, left, s) | between_contacts(recipe, angle, right, s))


def zoom_over_closing(recipe, path, angle, s, step, pitch, sign, scan):
    """The highest (sign 1) or the depth of the lowest (sign -1) over the closing, around a place:
    within half a section's width and a pass, and then twice more, each time ten times closer."""
    best = -math.inf
    reach = recipe.nose_radius * math.sin(recipe.nose_half_angle)
    for closer in (1, 10, 100):
        centre = (angle, s)
        for share in np.linspace(-0.5, 0.5, 11):
            degrees = centre[0] + share * step / closer
            places = centre[1] + pitch / closer * np.linspace(-1, 1, 81)
            places = places[counts_for_form(recipe, path, degrees, places)]
            if not len(places):
                continue
            theta = math.radians(degrees)
            closing, _ = closing_at(recipe, theta, places, places - reach, places + reach, scan)
            error = sign * (line_error(recipe, path, degrees, places) + recipe.profile(theta)(places) - closing)
            k = int(np.argmax(error))
            if error[k] > best:
                best, angle, s = float(error[k]), degrees, places[k]
    return best


def between_contacts(recipe, section_deg, x, s):
    """Which places lie between the contacts of the passes at the smallest and at the largest X. The
    contacts of the compensator `none` are the points of the path."""
    if recipe.compensator == "none":
        return (s >= x.min()) & (s <= x.max())
    profile, radius = recipe.profile(math.radians(section_deg)), recipe.nose_radius
    ends = []
    for centre in (x.min(), x.max()):
        off = radius * np.sin(np.linspace(-recipe.nose_half_angle, recipe.nose_half_angle, 400_001))
        ends.append(centre + off[np.argmax(profile(centre + off) + np.sqrt(radius**2 - off**2))])
    return (s >= ends[0]) & (s <= ends[1])


def control_points(recipe, path, scan=129):
    """How far the control points lie off the true tool centre, nm: the largest amount."""
    off = path.nodes[:, 3] - true_z(recipe, radians(path.nodes[:, 1]), path.nodes[:, 2], scan)
    return float(np.abs(off).max() * NM_PER_MM)


def spindle(path, instants=64):
    """How C turns as played: lowest and highest speed, and the largest acceleration."""
    tau = np.arange(instants + 1) / instants
    h = path.durations[:, None]
    start, end = path.nodes[:-1, 1, None], path.nodes[1:, 1, None]
    slope = [path.nodes[:-1, 4, None] * h, path.nodes[1:, 4, None] * h]
    square = 3 * (end - start) - 2 * slope[0] - slope[1]
    cube = slope[0] + slope[1] - 2 * (end - start)
    speed = (slope[0] + 2 * square * tau + 3 * cube * tau**2) / h
    acceleration = (2 * square + 6 * cube * tau) / h**2
    return {"lowest_deg_per_s": float(speed.min()), "highest_deg_per_s": float(speed.max()),
            "acceleration_deg_per_s2": float(np.abs(acceleration).max())}


def axes(path):
    """The largest velocity, acceleration and jerk of each axis over the cut, in deg or mm, and s.

    A cubic's acceleration is largest at an end of its segment, its jerk is constant on it, and its
    velocity is largest at an end or where the acceleration is zero."""
    h = path.durations
    figures = {}
    for axis, (p, v) in path.AXES.items():
        start, end = path.nodes[:-1, p], path.nodes[1:, p]
        first, last = path.nodes[:-1, v] * h, path.nodes[1:, v] * h
        square = 3 * (end - start) - 2 * first - last
        cube = first + last - 2 * (end - start)
        with np.errstate(divide="ignore", invalid="ignore"):
            turn = np.nan_to_num(-square / (3 * cube), nan=0.0, posinf=0.0, neginf=0.0)
        turn = np.clip(turn, 0, 1)
        between = first + 2 * square * turn + 3 * cube * turn**2
        velocity = np.abs(np.concatenate([first / h, last / h, between / h]))
        acceleration = np.abs(np.concatenate([2 * square / h**2, (2 * square + 6 * cube) / h**2]))
        figures[axis] = {"velocity": float(velocity.max()), "acceleration": float(acceleration.max()),
                         "jerk": float(np.abs(6 * cube / h**3).max())}
    return figures


def measure_schedule(recipe, path):
    """All figures, and those of a spindle that keeps the axes within limits."""
    return measure(recipe, path) | {"spindle": spindle(path), "axes": axes(path)}


def measure_slots(recipe, path):
    """All figures, and those of nodes off the locus and of a spindle that changes its speed."""
    return measure(recipe, path) | {"control_point_nm": control_points(recipe, path),
                                    "spindle": spindle(path)}


def measure(recipe, path, stride=1, instants=48, sections=90, scan=129):
    """All figures of a path, as printed."""
    if recipe.cuts_what_fits:  # hills of nearly one height are told apart on a finer scan
        scan = max(scan, SEAM_SCAN)
    surface, nose = surface_error(recipe, path), real_nose(recipe, path)
    figures = {"interpolation_error_nm": interpolation_error(recipe, path, stride, instants, scan),
               "residual_nm": residual(recipe, path, sections, scan),
               "played_cusp_nm": played_cusp(recipe, path, scan=scan),
               "surface_error_nm": surface,
               "real_nose_nm": nose,
               "coverage_nm": coverage(recipe, path, scan),
               "unreached": unreached(recipe),
               "rows": path.rows, "control_points": path.segments + 1,
               "revolutions": float(path.revolutions)}
    form = form_error(recipe, path, nose or surface, scan)
    return figures if form is None else figures | {"form_error_nm": form}


def main():
    """Command line."""
    parser = argparse.ArgumentParser(description="measure a toolpath.csv against its recipe")
    parser.add_argument("recipe")
    parser.add_argument("toolpath")
    parser.add_argument("--stride", type=int, default=1, help="play back every n-th segment only")
    parser.add_argument("--instants", type=int, default=48, help="steps a segment")
    parser.add_argument("--sections", type=int, default=90, help="section angles of the residual")
    parser.add_argument("--scan", type=int, default=129, help="nose angles scanned for the touch")
    given = parser.parse_args()
    figures = measure(Recipe.read(given.recipe), ToolPath.read(given.toolpath), given.stride,
                      given.instants, given.sections, given.scan)
    print(json.dumps(figures, indent=2))


if __name__ == "__main__":
    main()
