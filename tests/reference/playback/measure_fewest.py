#!/usr/bin/env python3
"""Runs turnpath with the fewest points on the four parts of docs/fewest-points.md, at a constant speed and with a
schedule, and keeps what playback.py measures on each path in minimax/parts.json.

    measure_fewest.py TURNPATH

The changes of each recipe stand in the file too, so that the test which holds turnpath's own figures against
these makes the same paths. The figures change only when a path does.
"""

import json
import subprocess
import sys
import tempfile
from concurrent.futures import ProcessPoolExecutor
from functools import partial
from pathlib import Path

from measure_random import EXCEEDED, HELD, INSTANTS, SCAN, SECTIONS
from playback import Recipe, ToolPath, interpolation_error, residual

HERE = Path(__file__).resolve().parent
RECIPES = HERE.parents[2] / "docs" / "recipes"
KEPT = HERE / "minimax" / "parts.json"
PARTS = {"astigmatic-5mm": ["45 deg"], "sinusoidal-array-10mm": ["45 deg"],
         "astigmatic-50mm": ["45 deg", "90 deg"], "off-axis-paraboloid-213mm": ["45 deg"]}
ALL = ["path.lead=false", "path.overrun=none", "velocity.use=analytic"]
# A fast spindle, at whose largest speed Z would accelerate too much on each of the parts.
SCHEDULE = ['spindle={ use = "per-revolution", speed = "3000 rpm" }',
            'machine={ c_acceleration = "1000 rad/s^2", c_jerk = "5e4 rad/s^3", '
            'z_acceleration = "500 mm/s^2", z_jerk = "2e5 mm/s^3" }']


def runs():
    """Every path: the recipe and its changes."""
    for recipe, steps in PARTS.items():
        for step in steps:
            sampler = f'sampler={{ use = "minimax", states = 7, max_step = "{step}" }}'
            for spindle in ([], SCHEDULE):
                yield {"recipe": recipe, "set": [*ALL, sampler, *spindle]}


def measured(program, run):
    """Makes the path of a run and measures its toolpath.csv."""
    file = RECIPES / f"{run['recipe']}.toml"
    with tempfile.TemporaryDirectory() as folder:
        changes = [word for change in run["set"] for word in ("--set", change)]
        command = [program, "run", file, "-o", folder, "--no-report", "--threads", "1", *changes]
        made = subprocess.run(command, capture_output=True, text=True)
        if made.returncode not in (HELD, EXCEEDED):
            raise SystemExit(f"{run}: exit {made.returncode}\n{made.stderr}")
        recipe, path = Recipe.read(file), ToolPath.read(Path(folder) / "toolpath.csv")
        return run | {"control_points": path.segments + 1,
                      "interpolation_error_nm": interpolation_error(recipe, path, 1, INSTANTS, SCAN)["max"],
                      "residual_nm": residual(recipe, path, SECTIONS, SCAN)["max"]}


def main():
    """Command line."""
    program = str(Path(sys.argv[1]).resolve())
    with ProcessPoolExecutor() as pool:
        every = list(pool.map(partial(measured, program), runs()))
    KEPT.write_text(json.dumps(every, indent=2, allow_nan=False) + "\n", encoding="utf-8")
    for run in every:
        print(run["recipe"], run["set"][3:5], run["control_points"],
              f"{run['interpolation_error_nm']:.4f} nm, residual {run['residual_nm']:.4f} nm")


if __name__ == "__main__":
    main()
