#!/usr/bin/env python3
"""Runs turnpath on recipes and keeps what playback.py measures on each path beside this script.

    measure_all.py TURNPATH [--plugins DIR] [RECIPE.toml …]

TURNPATH is the program. Without a recipe these are all of docs/recipes, hard/, sums/ and form/,
and all of slots/ if DIR has the libraries of tests/fixtures. Each recipe's figures go to `<recipe>.json` in
the folder of its references: this one for docs/recipes, hard/, sums/, form/, schedules/ and slots/ for their own. They
change only when a path does.
"""

import argparse
import json
import subprocess
import tempfile
from concurrent.futures import ProcessPoolExecutor
from functools import partial
from pathlib import Path

from playback import Recipe, ToolPath, measure, measure_schedule, measure_slots

HERE = Path(__file__).resolve().parent
RECIPES = HERE.parents[2] / "docs" / "recipes"
HARD = HERE / "hard"
SUMS = HERE / "sums"
FORM = HERE / "form"
SCHEDULES = HERE / "schedules"
SLOTS = HERE / "slots"  # recipes that need the fixture `two-speeds`
TOLERANCE_EXCEEDED = 1  # turnpath's exit status when a path is made but holds no tolerance


def reference_file(recipe):
    """Where the figures of a recipe are kept."""
    folder = recipe.parent if recipe.parent in (HARD, SUMS, FORM, SCHEDULES, SLOTS) else HERE
    return folder / f"{recipe.stem}.json"


def measure_recipe(program, plugins, recipe):
    """Runs `program` on the recipe and measures its toolpath.csv; gives the figures."""
    with tempfile.TemporaryDirectory() as folder:
        command = [program, "run", recipe, "-o", folder]
        command += ["--plugin-dir", plugins] if recipe.parent == SLOTS else []
        run = subprocess.run(command, capture_output=True, text=True)
        if run.returncode not in (0, TOLERANCE_EXCEEDED):
            raise SystemExit(f"{recipe.name}: exit {run.returncode}\n{run.stderr}")
        figures = {SLOTS: measure_slots, SCHEDULES: measure_schedule}.get(recipe.parent, measure)
        return figures(Recipe.read(recipe), ToolPath.read(Path(folder) / "toolpath.csv"))


def main():
    """Command line."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("recipes", nargs="*")
    parser.add_argument("--plugins")
    given = parser.parse_intermixed_args()
    program = str(Path(given.program).resolve())
    recipes = [Path(name).resolve() for name in given.recipes]
    if not recipes:
        folders = [RECIPES, HARD, SUMS, FORM, SCHEDULES] + ([SLOTS] if given.plugins else [])
        recipes = [recipe for folder in folders for recipe in sorted(folder.glob("*.toml"))]
    with ProcessPoolExecutor() as pool:
        for recipe, figures in zip(recipes, pool.map(partial(measure_recipe, program, given.plugins), recipes)):
            text = json.dumps(figures, indent=2, allow_nan=False) + "\n"
            reference_file(recipe).write_text(text, encoding="utf-8")
            error, cusp = figures["interpolation_error_nm"]["max"], figures["residual_nm"]["max"]
            print(f"{recipe.stem}: error {error:.4f} nm, residual {cusp or 0:.4f} nm")


if __name__ == "__main__":
    main()
