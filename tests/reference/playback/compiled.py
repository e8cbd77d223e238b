"""Recipes of playback.py whose first touch is machine code: the same formulas and the same search, one
position after the other. It takes a fortieth of the time, for measuring hundreds of paths.

Each recipe is held against playback.py before it is used.
"""

import math

import numba
import numpy as np

import playback
import surfaces

ROUNDS = 32  # of golden section, as in playback.climb
CHECKED = 40  # positions over the part that are held against playback.py
AGREES_MM = 1e-12

compiled = numba.njit(error_model="numpy")  # a division by zero gives what numpy gives


def search(sag):
    """`playback.first_touch` over arrays of one length; `out` gets the heights."""

    @compiled
    def height(cos, sin, x, radius, phi):
        rho = x + radius * math.sin(phi)
        z = sag(rho * cos, rho * sin) + radius * math.cos(phi)
        return -np.inf if np.isnan(z) else z

    @compiled
    def highest_hill(cos, sin, x, radius, angles):
        left, top = height(cos, sin, x, radius, angles[0]), height(cos, sin, x, radius, angles[1])
        best, where = left, angles[0]
        for i in range(1, len(angles)):
            right = height(cos, sin, x, radius, angles[i + 1]) if i + 1 < len(angles) else -np.inf
            bend, rise = 2 * top - left - right, 0.0
            if top >= left and top >= right and bend > 0 and np.isfinite(bend):
                rise = (right - left) ** 2 / (8 * bend)
            if top + rise > best:
                best, where = top + rise, angles[i]
            left, top = top, right
        return where

    @compiled
    def climb(cos, sin, x, radius, low, high):
        golden = (math.sqrt(5.0) - 1) / 2
        a, b = high - golden * (high - low), low + golden * (high - low)
        at_a, at_b = height(cos, sin, x, radius, a), height(cos, sin, x, radius, b)
        for _ in range(ROUNDS):
            if at_a > at_b:
                high, b, at_b = b, a, at_a
                a = high - golden * (high - low)
                at_a = height(cos, sin, x, radius, a)
            else:
                low, a, at_a = a, b, at_b
                b = low + golden * (high - low)
                at_b = height(cos, sin, x, radius, b)
        ends = max(height(cos, sin, x, radius, low), height(cos, sin, x, radius, high))
        return max(at_a, at_b, ends)

    @compiled
    def touch(cos, sin, x, radius, angles, out):
        step = angles[1] - angles[0]
        for k in range(len(x)):
            hill = highest_hill(cos[k], sin[k], x[k], radius, angles)
            low, high = max(hill - step, angles[0]), min(hill + step, angles[-1])
            out[k] = climb(cos[k], sin[k], x[k], radius, low, high)

    return touch


class CompiledRecipe(playback.Recipe):
    """A recipe with a compiled first touch."""

    def __init__(self, table):
        super().__init__(table)
        self.search = search(surfaces.surface(table, compiled))
        self.check()

    def touch(self, theta, x, scan):
        theta, x = np.broadcast_arrays(np.asarray(theta, float), np.asarray(x, float))
        out = np.empty(theta.size)
        angles = np.linspace(-self.nose_half_angle, self.nose_half_angle, scan)
        self.search(np.cos(theta).ravel(), np.sin(theta).ravel(), np.ascontiguousarray(x).ravel(),
                    self.nose_radius, angles, out)
        return out.reshape(theta.shape)

    def check(self):
        """Compares the search with that of playback.py on a spiral over the part."""
        along = np.linspace(0.01, 0.99, CHECKED)
        theta, x = 200 * along, along * self.part_radius
        one, other = self.touch(theta, x, 129), playback.first_touch(self, theta, x, 129)
        off = np.abs(one - other)[np.isfinite(one) | np.isfinite(other)]
        if not np.all(off < AGREES_MM):
            raise SystemExit(f"the compiled first touch is off by {off.max()} mm")
