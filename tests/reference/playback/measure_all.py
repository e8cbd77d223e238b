#!/usr/bin/env python3
"""Runs turnpath on recipes and keeps what playback.py measures on each path beside this script.

    measure_all.py TURNPATH [RECIPE.toml …]     without a recipe: all of docs/recipes and hard/

TURNPATH is the program. Each recipe's figures go to `<recipe>.json` in the folder of its
references: this one for docs/recipes, hard/ for hard/. They change only when a path does.
"""

import json
import subprocess
import sys
import tempfile
from concurrent.futures import ProcessPoolExecutor
from functools import partial
from pathlib import Path

from playback import Recipe, ToolPath, measure

HERE = Path(__file__).resolve().parent
RECIPES = HERE.parents[2] / "docs" / "recipes"
HARD = HERE / "hard"
TOLERANCE_EXCEEDED = 1  # turnpath's exit status when a path is made but holds no tolerance


def reference_file(recipe):
    """Where the figures of a recipe are kept."""
    folder = HARD if recipe.parent == HARD else HERE
    return folder / f"{recipe.stem}.json"


def measure_recipe(program, recipe):
    """Runs `program` on the recipe and measures its toolpath.csv; gives the figures."""
    with tempfile.TemporaryDirectory() as folder:
        run = subprocess.run([program, "run", recipe, "-o", folder], capture_output=True, text=True)
        if run.returncode not in (0, TOLERANCE_EXCEEDED):
            raise SystemExit(f"{recipe.name}: exit {run.returncode}\n{run.stderr}")
        return measure(Recipe.read(recipe), ToolPath.read(Path(folder) / "toolpath.csv"))


def main():
    """Command line."""
    if len(sys.argv) < 2:
        raise SystemExit(__doc__)
    program = str(Path(sys.argv[1]).resolve())
    given = [Path(name).resolve() for name in sys.argv[2:]]
    recipes = given or sorted(RECIPES.glob("*.toml")) + sorted(HARD.glob("*.toml"))
    with ProcessPoolExecutor() as pool:
        for recipe, figures in zip(recipes, pool.map(partial(measure_recipe, program), recipes)):
            text = json.dumps(figures, indent=2, allow_nan=False) + "\n"
            reference_file(recipe).write_text(text, encoding="utf-8")
            error, cusp = figures["interpolation_error_nm"]["max"], figures["residual_nm"]["max"]
            print(f"{recipe.stem}: error {error:.4f} nm, residual {cusp or 0:.4f} nm")


if __name__ == "__main__":
    main()
