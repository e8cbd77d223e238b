#!/usr/bin/env python3
"""An independent evaluation of a program of the post `beckhoff-poly`.

Written from Beckhoff, TF5200 Programming manual, "Programming an axis polynomial (POLY)", "Definition of
feed axes (#FGROUP)" and "Machining time or feedrate (G93/G94/G95/G194)"; shares no code with turnpath:

    p(s) = A0 + A1 s + A2 s^2 + A3 s^3 + A4 s^4 + A5 s^5,  0 <= s <= L,  L = 1 if it is not programmed;
    a coefficient that is not programmed is 0, and A0 must be; positions are absolute, in mm and deg;
    a polynomial is for one block; s goes from 0 to L in step with the way of the block
    #FGROUP [W]: F is the speed of W alone;  G94: F in mm/min
    G1 W5: W goes straight from where it stands to 5

    beckhoff_poly.py cutting-speed.ncp > beckhoff_poly.csv
    beckhoff_poly.py cutting-speed.ncp beckhoff_poly.csv

The first prints t, C, X, Z at s = 0, L/4, L/2 and 3L/4 of each block, in s, deg and mm. The numbers are decimal
fractions of 50 digits until they are printed. A polynomial that does not begin where the one before ends, to
the last digit, ends the script. The second compares with what was printed. cutting-speed.ncp is what turnpath
wrote for cutting-speed.toml, whose spindle changes its speed. The tests hold turnpath's reader of programs
against the table: it finds the same places at the same times. Its writer is held against the path by the
reader. That W starts from rest and takes a moment to its speed is not in the table.
"""

import re
import sys
from decimal import Decimal, getcontext
from pathlib import Path

getcontext().prec = 50
POLYNOMIAL = re.compile(r"([CXZ])\[POLY ([^]]*)\]")
WAY = re.compile(r"(?:^| )W(-?[\d.]+)")


def coefficients(text):
    """L and A0 to A5."""
    said = dict(word.split("=") for word in text.split())
    if "A0" not in said:
        sys.exit(f"A0 is not programmed: {text}")
    polynomial = [Decimal(said.pop(f"A{k}", "0")) for k in range(6)]
    limit = Decimal(said.pop("L", "1"))
    if said or limit <= 0:
        sys.exit(f"this is no polynomial: {text}")
    return limit, polynomial


def value(polynomial, s):
    place = Decimal(0)
    for a in reversed(polynomial):
        place = place * s + a
    return place


def played(program):
    """The lines of the table."""
    position, feed_axes, feed, way, time = None, None, None, None, Decimal(0)
    yield "t_s,c_deg,x_mm,z_mm"
    for line in program.splitlines():
        code = line.split(";")[0].strip()
        if code.startswith("#FGROUP"):
            feed_axes = code.removeprefix("#FGROUP").strip()
        elif code.startswith("G1 C"):
            words = re.findall(r"([CXZ])(-?[\d.]+)", code)
            position = {axis: Decimal(value) for axis, value in words}
        elif code.startswith("G0 W"):
            way = Decimal(WAY.search(code).group(1))
        elif "[POLY" in code:
            if feed_axes != "[W]":
                sys.exit(f"F is not the speed of W: {line}")
            if "G94" in code:
                feed = Decimal(re.search(r" F([\d.]+)$", code).group(1))
            to = Decimal(WAY.search(code).group(1))
            seconds = (to - way) / feed * 60
            found = {axis: coefficients(text) for axis, text in POLYNOMIAL.findall(code)}
            for axis, (_, polynomial) in found.items():
                if polynomial[0] != position[axis]:
                    sys.exit(f"{axis} does not begin at {position[axis]}: {line}")
            for axis in position.keys() - found.keys():
                found[axis] = Decimal(1), [position[axis]] + [Decimal(0)] * 5
            for quarter in range(4):
                share = Decimal(quarter) / 4
                row = [time + share * seconds]
                row += [value(found[axis][1], share * found[axis][0]) for axis in "CXZ"]
                yield ",".join(f"{value:.15f}" for value in row)
            position = {axis: value(polynomial, limit) for axis, (limit, polynomial) in found.items()}
            way, time = to, time + seconds


def main():
    lines = list(played(Path(sys.argv[1]).read_text()))
    if len(sys.argv) < 3:
        print("\n".join(lines))
    elif lines != Path(sys.argv[2]).read_text().splitlines():
        sys.exit(f"{sys.argv[2]} is not what {sys.argv[1]} plays")


if __name__ == "__main__":
    main()
