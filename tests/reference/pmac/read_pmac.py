#!/usr/bin/env python3
"""An independent reading of a program of the post `pmac-pvt`.

Written from the Turbo PMAC manuals' description of PVT moves; shares no code with turnpath. The
program is taken as the post writes it by default: ABS, C unwrapped, velocities per second, Z of
the tool's tip.

    read_pmac.py RECIPE.toml PROGRAM.pmc toolpath.csv > ast-5.json

prints JSON: the points, their time, how far times and places are from those of toolpath.csv, and
the interpolation error of the program's own cubics, measured as ../playback does.
"""

import csv
import hashlib
import json
import re
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "playback"))
import numpy as np  # noqa: E402
import playback  # noqa: E402

QUANTA_PER_MS = 4096
WORD = re.compile(r"([CXZ])(-?\d+(?:\.\d+)?):(-?\d+(?:\.\d+)?)\s*")


def read(path):
    """Times in quanta from the first point on, and [[c, x, z, vc, vx, vz], …]."""
    quanta, rows, time, inside = [], [], None, False
    for line in Path(path).read_text().splitlines():
        if line.startswith("; -- cutting"):
            inside = True
        elif line.startswith("; -- end of path"):
            return quanta, rows
        elif inside and line.startswith("PVT"):
            time = round(float(line[3:]) * QUANTA_PER_MS)
        elif inside and line[0] == "C":
            words = {axis: (float(p), float(v)) for axis, p, v in WORD.findall(line)}
            assert WORD.sub("", line) == "" and sorted(words) == ["C", "X", "Z"], line
            quanta.append(quanta[-1] + time if quanta else 0)
            rows.append([words[axis][k] for k in (0, 1) for axis in "CXZ"])
    raise SystemExit(f"{path} ends too early")


def main():
    recipe_file, program, table = sys.argv[1:]
    recipe = playback.Recipe.read(recipe_file)
    quanta, rows = read(program)
    seconds = [q / QUANTA_PER_MS / 1000 for q in quanta]
    tip = recipe.nose_radius
    made = [[t, c, x, z + tip, vc, vx, vz, 1]
            for t, (c, x, z, vc, vx, vz) in zip(seconds, rows)]
    with open(table) as file:
        wanted = [[float(v) for v in row] for row in list(csv.reader(file))[1:]]
    assert len(made) == len(wanted)
    late = [m[0] - w[0] for m, w in zip(made, wanted)]
    # Each point is on the path at its own time: along the velocity, but for the curvature.
    off = [max(abs(m[k] - w[k] - w[k + 3] * dt) for m, w, dt in zip(made, wanted, late))
           for k in (1, 2, 3)]
    error = playback.interpolation_error(recipe, playback.ToolPath(np.array(made)), instants=48)
    print(json.dumps({
        "recipe_sha256": hashlib.sha256(Path(recipe_file).read_bytes()).hexdigest(),
        "points": len(made),
        "time_s": seconds[-1],
        "late_quanta_max": max(abs(dt) for dt in late) * 1000 * QUANTA_PER_MS,
        "off": dict(zip(("c_deg", "x_mm", "z_mm"), off)),
        "interpolation_error_nm": error,
    }, indent=2))


main()
