#!/usr/bin/env python3
"""Runs turnpath on random recipes and holds each path against playback.py.

    measure_random.py TURNPATH FOLDER [--first N] [--count M] [--seconds S]

FOLDER has the recipes; `cargo test -p turnpath-cli --test program -- --ignored five_hundred` writes
them to `fewest-points` in the tests' scratch folder, CARGO_TARGET_TMPDIR. For each recipe playback.py
measures the interpolation error and the residual of the path, with the first touch of compiled.py. A
complaint is a figure that differs from the summary's by more than 2 %, or that is beyond its tolerance
while turnpath says it holds, or a status that is neither that of a path nor that of a refused recipe.
With --seconds no recipe is begun after that time. The status is 1 if there is a complaint, or if nothing
was measured.
"""

import argparse
import json
import subprocess
import sys
import tempfile
import time
from concurrent.futures import ProcessPoolExecutor
from functools import partial
from pathlib import Path

from compiled import CompiledRecipe
from playback import SEAM_SCAN, ToolPath, coverage, interpolation_error, residual

AGREES = 0.02
ROUNDING_NM = 1e-3
ALLOWED = 1.001  # a tolerance holds up to this times itself
HELD, EXCEEDED = 0, 1  # turnpath's exit status when there is a path
REFUSED = 2  # when it refuses the recipe
INSTANTS, SECTIONS, SCAN = 48, 90, 129


def complaints(summary, figures):
    """What differs between the summary and the independent figures."""
    found = []
    for name, key in (("interpolation", "interpolation_error"), ("residual", "residual")):
        here, there = summary[key]["max_nm"], figures[f"{key}_nm"]["max"]
        tolerance = summary["tolerance"][f"{name}_nm"]
        if here is None or there is None:
            if here != there:
                found.append(f"{name}: {here} nm, measured {there} nm")
            continue
        if abs(here - there) > max(AGREES * there, ROUNDING_NM):
            found.append(f"{name}: {here:.4f} nm, measured {there:.4f} nm")
        if summary["within"][name] and there > ALLOWED * tolerance:
            found.append(f"{name}: measured {there:.4f} nm of {tolerance} nm")
    return found


def residual_with_axis(recipe, path, scan, summary):
    """The residual with the cusp between both sides of the axis, which turnpath counts where the path
    covers the axis. The reference has it as what stays uncut around the axis, at many more angles; so it
    is measured where the residual beside the axis is not all."""
    beside = residual(recipe, path, SECTIONS, scan)
    here = summary["residual"]["max_nm"]
    if not recipe.covers_axis or here is None or (beside["max"] or 0.0) * (1 + AGREES) >= here:
        return beside
    centre = coverage(recipe, path, scan)["centre"]
    return {"max": max(beside["max"] or 0.0, centre or 0.0)}


def judge(program, until, file):
    """What is wrong with the path of one recipe: (name, status or None if not begun, complaints)."""
    if until and time.time() > until:
        return file.name, None, []
    with tempfile.TemporaryDirectory() as folder:
        command = [program, "run", file, "-o", folder, "--threads", "1"]
        run = subprocess.run(command, capture_output=True, text=True)
        if run.returncode not in (HELD, EXCEEDED):
            wrong = [] if run.returncode == REFUSED else [f"status {run.returncode}"]
            return file.name, run.returncode, wrong
        summary = json.loads((Path(folder) / "summary.json").read_text(encoding="utf-8"))
        recipe, path = CompiledRecipe.read(file), ToolPath.read(Path(folder) / "toolpath.csv")
        scan = SEAM_SCAN if recipe.cuts_what_fits else SCAN
        figures = {"interpolation_error_nm": interpolation_error(recipe, path, 1, INSTANTS, scan),
                   "residual_nm": residual_with_axis(recipe, path, scan, summary)}
        return file.name, run.returncode, complaints(summary, figures)


def main():
    """Command line."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("folder")
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--count", type=int)
    parser.add_argument("--seconds", type=float)
    given = parser.parse_args()
    files = sorted(Path(given.folder).resolve().glob("*.toml"))[given.first:]
    files = files[:given.count]
    until = time.time() + given.seconds if given.seconds else None
    program = str(Path(given.program).resolve())
    measured, refused, wrong = 0, 0, 0
    with ProcessPoolExecutor() as pool:
        for name, status, found in pool.map(partial(judge, program, until), files):
            measured += status in (HELD, EXCEEDED)
            refused += status == REFUSED
            wrong += bool(found)
            for complaint in found:
                print(f"{name}: {complaint}", flush=True)
    print(f"{len(files)} recipes: {measured} measured, {refused} refused, "
          f"{len(files) - measured - refused} not begun or failed; {wrong} with complaints")
    sys.exit(1 if wrong or not measured else 0)


if __name__ == "__main__":
    main()
