#!/usr/bin/env python3
"""What LinuxCNC's own interpreter makes of a program of the post `linuxcnc-g93`.

    linuxcnc.py saddle.ngc > linuxcnc.csv
    linuxcnc.py saddle.ngc linuxcnc.csv     (compares; status 1 if they differ)

prints t, C, X, Z at the end of each line, in s, deg and mm. The path of saddle.ngc is what turnpath
writes for saddle.toml with `--set output.posts=["linuxcnc-g93"]`. The file stands without the moves
before and after it, of which the script knows nothing.

The interpreter is the module `gcode` of Debian's package linuxcnc-uspace (2.9.0~pre1+git20230208),
which belongs to the system's python3. It gives the ends of lines in inches and deg, and the feed rate
that it made of F. A line takes its length over the rate: the length in X and Z, or that in C where X
and Z stand still (src/emc/rs274ngc/interp_find.cc, find_straight_length; src/emc/task/emccanon.cc,
getStraightVelocity). This version plays no rate below 0.1 in a minute
(src/emc/rs274ngc/interp_inverse.cc, inverse_time_rate_straight).

The package need not be installed: with its files under DIR, and those of libboost-python1.74.0,
    LD_LIBRARY_PATH=DIR/usr/lib:DIR/usr/lib/x86_64-linux-gnu
    PYTHONPATH=DIR/usr/lib/python3/dist-packages
are enough.
"""

import math
import os
import sys
import tempfile

import gcode

INCH = 25.4
# An axis that moves by less than this stands still (CART_FUZZ in src/libposemath/posemath_types.h).
FUZZ = 1e-8
POSITION_MM = 1e-9
ANGLE_DEG = 1e-7
TIME_S = 1e-6


class Canon:
    """Takes what the interpreter says."""

    def __init__(self, parameter_file):
        self.parameter_file = parameter_file
        self.rate = None
        self.time = 0.0
        self.place = None
        self.rows = []

    def __getattr__(self, name):
        return lambda *arguments: None

    def get_external_length_units(self):
        return 1.0

    def get_external_angular_units(self):
        return 1.0

    def get_axis_mask(self):
        return 0b100101

    def get_block_delete(self):
        return 0

    def is_lathe(self):
        return False

    def check_abort(self):
        return False

    def get_tool(self, pocket):
        return (-1,) + (0.0,) * 12 + (0,)

    def set_feed_rate(self, rate):
        # Units in a minute: inches or deg. The program's are mm: the interpreter divides them by 25.4.
        self.rate = rate

    def dwell(self, seconds):
        self.time += seconds
        self.rows.append((self.time, *self.place))

    def straight_feed(self, x, y, z, a, b, c, u, v, w):
        place = (c, x * INCH, z * INCH)
        if self.place is not None:
            way = [to - begin for to, begin in zip(place, self.place)]
            way = [0.0 if abs(one) < FUZZ else one for one in way]
            length = math.hypot(way[1], way[2])
            length = length / INCH if length > 0.0 else abs(way[0]) / INCH
            self.time += 60.0 * length / self.rate
        self.place = place
        self.rows.append((self.time, *place))


def rows_of(program):
    with tempfile.TemporaryDirectory() as folder:
        parameters = os.path.join(folder, "linuxcnc.var")
        open(parameters, "w").close()
        canon = Canon(parameters)
        result, line = gcode.parse(program, canon, "", "")
    if result > gcode.MIN_ERROR:
        sys.exit(f"{program}, line {line}: {gcode.strerror(result)}")
    return canon.rows


def compare(rows, file):
    kept = [tuple(map(float, line.split(","))) for line in open(file).read().split()[1:]]
    if len(rows) != len(kept):
        sys.exit(f"{len(rows)} lines, and {len(kept)} in {file}")
    bounds = (TIME_S, ANGLE_DEG, POSITION_MM, POSITION_MM)
    for number, (row, other) in enumerate(zip(rows, kept), 1):
        for one, two, bound in zip(row, other, bounds):
            if abs(one - two) > bound:
                sys.exit(f"line {number}: {row} and {other}")
    print(f"{len(rows)} lines are those of {file}")


def main():
    rows = rows_of(sys.argv[1])
    if len(sys.argv) > 2:
        return compare(rows, sys.argv[2])
    print("t_s,c_deg,x_mm,z_mm")
    for row in rows:
        print(",".join(f"{value:.12f}" for value in row))


if __name__ == "__main__":
    main()
