"""The chain of equal-angle.toml in numpy, without any check: nodes, first touch, velocities, program.

    numpy_chain.py [FILE] [--points N]

It is vectorised in chunks that stay in cache, and measures nothing. Text is made by one call of `%` for a
chunk, the fastest way to format numbers that numpy or Python has built in. Standard output has the
processor time of making the points and of writing them, s, as JSON.
"""

import argparse
import json
import time

import numpy as np

from chain import DEG, DECIMALS, FEED, K, PER_TURN, RADIUS, RIM, STEPS_PER_S, TURN_S, TURNS, count

CHUNK = 1 << 14
STEPS_OF_NEWTON = 4


def surface(x, y):
    """Height and slopes."""
    return 2.0 * K * x * y, 2.0 * K * y, 2.0 * K * x


def points(first, last):
    """Control points first to last: steps of time, C in deg, X, Z of the tip, and their velocities."""
    n = np.minimum(np.arange(first, last) / PER_TURN, TURNS)
    times = n * TURN_S * STEPS_PER_S
    # The path does not run beyond its end.
    steps = np.where(n < TURNS, np.rint(times), np.floor(times))
    n = steps / STEPS_PER_S / TURN_S
    c = 2.0 * np.pi * n
    x = RIM - FEED * n
    sin, cos = np.sin(c), np.cos(c)
    offset = np.zeros_like(x)
    for _ in range(STEPS_OF_NEWTON):
        foot = x + offset
        _, zx, zy = surface(foot * cos, foot * sin)
        slope = zx * cos + zy * sin
        # The foot has offset = R slope/w; the rate of the difference is near 1 where a nose fits.
        offset -= offset - RADIUS * slope / np.sqrt(1.0 + slope * slope)
    foot = x + offset
    z, zx, zy = surface(foot * cos, foot * sin)
    height = z + np.sqrt((RADIUS - offset) * (RADIUS + offset)) - RADIUS
    c_rate = 2.0 * np.pi / TURN_S
    x_rate = -FEED / TURN_S
    z_rate = foot * (zy * cos - zx * sin) * c_rate + (zx * cos + zy * sin) * x_rate
    velocities = np.full_like(c, c_rate / DEG), np.full_like(c, x_rate), z_rate
    return steps.astype(np.int64), (c / DEG, x, height), velocities


def lines(steps, before, positions, velocities):
    """The text of a chunk."""
    columns = np.empty((len(steps), 7))
    columns[:, 0] = np.diff(steps, prepend=before) / (STEPS_PER_S / 1000)
    columns[:, 1::2] = np.stack(positions, axis=1)
    columns[:, 2::2] = np.stack(velocities, axis=1)
    number = f"%.{DECIMALS}f"
    line = "PVT%.12g\n" + " ".join(f"{axis}{number}:{number}" for axis in "CXZ") + "\n"
    return (line * len(steps)) % tuple(columns.ravel().tolist())


def main():
    arguments = argparse.ArgumentParser()
    arguments.add_argument("file", nargs="?", default="/dev/null")
    arguments.add_argument("--points", type=int, default=count())
    chosen = arguments.parse_args()
    total = chosen.points
    making = writing = 0.0
    before = 0
    with open(chosen.file, "w") as file:
        file.write("; -- cutting --\nABS\n")
        for first in range(0, total, CHUNK):
            began = time.process_time()
            steps, positions, velocities = points(first, min(first + CHUNK, total))
            made = time.process_time()
            file.write(lines(steps, before, positions, velocities))
            before = steps[-1]
            making += made - began
            writing += time.process_time() - made
        file.write(f"; -- end of path: {total} points --\n")
    print(json.dumps({"points": total, "making_s": making, "writing_s": writing}))


if __name__ == "__main__":
    main()
