#!/usr/bin/env python3
"""An independent evaluation of a program of the post `siemens-840d-poly`.

Written from Siemens, SINUMERIK Job Planning (6FC5398-2BP40), "Polynomial interpolation (POLY,
POLYPATH, PO, PL)" and "Settable path reference (SPATH, UPATH)"; shares no code with turnpath:

    f(p) = a0 + a1 p + a2 p^2 + a3 p^3,  0 <= p <= PL,  PL = 1 if it is not programmed
    PO[X]=(xe, a2, a3): a0 is the axis position at the end of the preceding block,
    a1 = (xe - a0 - a2 PL^2 - a3 PL^3) / PL; the last coefficients may be left out if they are zero
    G93: F is the inverse of the time of a block, in 1/min
    FGROUP(C), UPATH: the way of C is the path to which F refers, so C is even in time within a block;
    X and Z belong to the parameter at which C is where it is

    siemens_840d.py saddle.mpf > siemens_840d.csv
    siemens_840d.py saddle.mpf siemens_840d.csv

The first prints t, C, X, Z at p = 0, 1/4, 1/2 and 3/4 of each block, in s, deg and mm; t is when C is there. The numbers are
decimal fractions of 50 digits until they are printed. The second compares with what was printed.
saddle.mpf is what turnpath wrote for saddle.toml. The tests hold turnpath's reader of programs against
the table: it finds the same places at the same times. Its writer is held against the path by the reader.
"""

import re
import sys
from decimal import Decimal, getcontext
from pathlib import Path

getcontext().prec = 50
POLYNOMIAL = re.compile(r"PO\[([CXZ])\]=\(([^)]*)\)")


def value(cubic, p):
    a0, a1, a2, a3 = cubic
    return a0 + a1 * p + a2 * p * p + a3 * p * p * p


def played(program):
    """The lines of the table."""
    position, time = None, Decimal(0)
    yield "t_s,c_deg,x_mm,z_mm"
    for line in program.splitlines():
        code = line.split(";")[0].strip()
        if code.startswith("G1 "):
            words = re.findall(r"([CXZ])(-?[\d.]+)", code)
            position = {axis: Decimal(value) for axis, value in words}
        elif "PO[" in code:
            minutes = 1 / Decimal(re.search(r" F([\d.]+)$", code).group(1))
            ends = dict(position)
            cubics = {axis: (start, Decimal(0), Decimal(0), Decimal(0)) for axis, start in position.items()}
            for axis, text in POLYNOMIAL.findall(code):
                end, a2, a3 = ([Decimal(value) for value in text.split(",")] + [Decimal(0)] * 2)[:3]
                a0 = position[axis]
                cubics[axis] = (a0, end - a0 - a2 - a3, a2, a3)
                ends[axis] = end
            for quarter in range(4):
                p = Decimal(quarter) / 4
                values = [value(cubics[axis], p) for axis in "CXZ"]
                share = (values[0] - position["C"]) / (ends["C"] - position["C"])
                row = [time + share * minutes * 60, *values]
                yield ",".join(f"{value:.15f}" for value in row)
            position, time = ends, time + minutes * 60


def main():
    lines = list(played(Path(sys.argv[1]).read_text()))
    if len(sys.argv) < 3:
        print("\n".join(lines))
    elif lines != Path(sys.argv[2]).read_text().splitlines():
        sys.exit(f"{sys.argv[2]} is not what {sys.argv[1]} plays")


if __name__ == "__main__":
    main()
