"""The chain of equal-angle.toml in numba, without any check: nodes, first touch, velocities, program.

    numba_chain.py [FILE] [--points N]

Everything is one compiled loop over the points, which writes digits straight into a buffer. It is compiled
before it is timed. Standard output has the processor time of making and writing, s, as JSON.
"""

import argparse
import json
import time
from math import cos, pi, sin, sqrt

import numba
import numpy as np

from chain import DEG, DECIMALS, FEED, K, PER_TURN, RADIUS, RIM, STEPS_PER_S, TURN_S, TURNS, count

# Points of a piece of text.
PIECE = 1 << 14
# More bytes than the lines of a point have.
LONGEST = 160
# Newton's method ends at a step of this part of the nose radius.
CLOSE = 1e-15
ONE = 10**DECIMALS
# Times have twelve decimals, exactly: a step is 1/4096 ms.
TIME_DECIMALS = 12


@numba.njit(inline="always")
def put_digits(text, at, size):
    """Appends a whole number."""
    ten = 10
    while ten <= size:
        ten *= 10
    while ten > 1:
        ten //= 10
        digit = size // ten
        text[at] = 48 + digit
        size -= digit * ten
        at += 1
    return at


@numba.njit(inline="always")
def put(text, at, units, one):
    """Appends `units` last digits without trailing zeros."""
    if units < 0:
        text[at] = 45
        at += 1
        units = -units
    whole = units // one
    at = put_digits(text, at, whole)
    fraction = units - whole * one
    if fraction > 0:
        text[at] = 46
        at += 1
        while fraction > 0:
            one //= 10
            digit = fraction // one
            text[at] = 48 + digit
            at += 1
            fraction -= digit * one
    return at


@numba.njit(inline="always")
def put_axis(text, at, letter, position, velocity):
    text[at] = letter
    at = put(text, at + 1, int(np.rint(position * ONE)), ONE)
    text[at] = 58
    return put(text, at + 1, int(np.rint(velocity * ONE)), ONE)


@numba.njit(inline="always")
def surface(x, y):
    """Height and slopes."""
    return 2.0 * K * x * y, 2.0 * K * y, 2.0 * K * x


@numba.njit
def write(text, first, last, before, step_before):
    """Makes and writes points first to last; gives the bytes, and the time of the last point."""
    at = 0
    c_rate, x_rate = 2.0 * pi / TURN_S, -FEED / TURN_S
    for k in range(first, last):
        n = min(k / PER_TURN, TURNS)
        steps = n * TURN_S * STEPS_PER_S
        # The path does not run beyond its end.
        steps = int(np.rint(steps)) if n < TURNS else int(steps)
        n = steps / STEPS_PER_S / TURN_S
        c, x = 2.0 * pi * n, RIM - FEED * n
        s, co = sin(c), cos(c)
        offset = 0.0
        for _ in range(50):
            foot = x + offset
            z, zx, zy = surface(foot * co, foot * s)
            slope = zx * co + zy * s
            step = RADIUS * slope / sqrt(1.0 + slope * slope) - offset
            offset += step
            if abs(step) < CLOSE * RADIUS:
                break
        foot = x + offset
        z, zx, zy = surface(foot * co, foot * s)
        z += sqrt((RADIUS - offset) * (RADIUS + offset)) - RADIUS
        z_rate = foot * (zy * co - zx * s) * c_rate + (zx * co + zy * s) * x_rate
        if k > 0 and steps - before != step_before:
            step_before = steps - before
            text[at], text[at + 1], text[at + 2] = 80, 86, 84
            at = put(text, at + 3, step_before * (10**TIME_DECIMALS // 4096), 10**TIME_DECIMALS)
            text[at] = 10
            at += 1
        before = steps
        at = put_axis(text, at, 67, c / DEG, c_rate / DEG)
        text[at] = 32
        at = put_axis(text, at + 1, 88, x, x_rate)
        text[at] = 32
        at = put_axis(text, at + 1, 90, z, z_rate)
        text[at] = 10
        at += 1
    return at, before, step_before


def chain(file, total):
    text = np.empty(PIECE * LONGEST, dtype=np.uint8)
    before, step_before = 0, 0
    file.write(b"; -- cutting --\nABS\nPVT1000\n")
    for first in range(0, total, PIECE):
        last = min(first + PIECE, total)
        at, before, step_before = write(text, first, last, before, step_before)
        file.write(memoryview(text)[:at])
    file.write(b"; -- end of path: %d points --\n" % total)


def main():
    arguments = argparse.ArgumentParser()
    arguments.add_argument("file", nargs="?", default="/dev/null")
    arguments.add_argument("--points", type=int, default=count())
    chosen = arguments.parse_args()
    with open("/dev/null", "wb") as file:
        chain(file, 10)
    with open(chosen.file, "wb") as file:
        began = time.process_time()
        chain(file, chosen.points)
        print(json.dumps({"points": chosen.points, "all_s": time.process_time() - began}))


if __name__ == "__main__":
    main()
