#!/usr/bin/env python3
"""An independent reading of the dry runs that `turnpath run --dry-run` writes.

Written from the controllers' manuals; shares no code with turnpath:

    dry_run.py toolpath.csv NOSE_RADIUS_MM CLEARANCE_MM PROGRAM...

prints the stops of each program, and ends with 1 unless each has four stops a quarter of a turn apart
(and one more at most, between two of them), and no move is lower than the clearance above the highest place of the path, Z of the tool's tip, as far
as the program rounds it.
"""

import csv
import re
import sys
from pathlib import Path

# How far a program may round the highest place of the path, mm: half the step in which leads move for
# LinuxCNC. Half the last of six decimals is less.
ROUNDED = 3.35e-6
STOPS = {"STOP", "M0", "ProgramPause()"}
PLACE = re.compile(r"(?:MoveRapid\(\[)?([CXZ])(?:\], \[)?(-?\d+(?:\.\d+)?)")


def read(text):
    """The places (C, X, Z) at the stops, and the lowest Z."""
    at, stops, lowest = {}, [], float("inf")
    for line in text.splitlines():
        code = re.split(r";|//", line)[0].strip()
        if code in STOPS:
            stops.append((at["C"], at["X"], at["Z"]))
        elif not code.startswith(("OPEN", "open", "Setup")):
            for axis, place in PLACE.findall(code):
                assert axis == "Z" or "Z" in at, f"{line}: before Z"
                at[axis] = float(place)
                lowest = min(lowest, at["Z"])
    return stops, lowest


def main():
    table, nose, clearance, *programs = sys.argv[1:]
    with open(table) as file:
        highest = max(float(row["z_mm"]) for row in csv.DictReader(file)) - float(nose)
    good = True
    for program in programs:
        stops, lowest = read(Path(program).read_text())
        turns = [(stop[0] - stops[0][0]) % 360 for stop in stops]
        quarters = [turn for turn in turns if turn % 90 == 0]
        right = quarters in ([0, 90, 180, 270], [0, 270, 180, 90]) and len(turns) <= 5
        right &= lowest >= highest + float(clearance) - ROUNDED
        print(f"{Path(program).name}: stops {stops}, {lowest - highest:.3f} mm above the path: {right}")
        good &= right
    sys.exit(0 if good else 1)


if __name__ == "__main__":
    main()
