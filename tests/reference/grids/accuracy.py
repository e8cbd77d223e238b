#!/usr/bin/env python3
"""The path over a grid of a known surface, against the surface itself: the table of docs/maps.md.

    accuracy.py TURNPATH            # needs numpy

A ready recipe gets its surface replaced by a grid of it, of 64, 256 and 1024 points along a side, in
the format of Zemax with all digits. The program runs it, and playback.py measures the path against
the formula. The first row of each part is the path over the formula.
"""

import re
import subprocess
import sys
import tempfile
import tomllib
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "tests/reference/playback"))

from playback import NM_PER_MM, Recipe, ToolPath, interpolation_error  # noqa: E402

PAGE = ROOT / "docs/maps.md"
BEGIN = "<!-- `cargo xtask reference maps` writes this table -->"
PARTS = [("astigmatic-5mm", 5.4), ("sinusoidal-array-10mm", 10.6)]  # the side of the grid, mm
SIZES = [64, 256, 1024]


def grid(sag, side, count, file):
    pitch = side / (count - 1)
    place = pitch * (np.arange(count) - 0.5 * (count - 1))
    with open(file, "w") as text:
        text.write(f"{count} {count} {pitch!r} {pitch!r} 0 0 0\n")
        for y in place[::-1]:
            text.writelines(f"{float(z)!r} 0 0 0\n" for z in sag(place, y))
    return pitch


def run(program, recipe, out):
    subprocess.run([program, "run", recipe, "-o", out], check=False, stdout=subprocess.DEVNULL)
    return ToolPath.read(out / "toolpath.csv")


def sags(program, recipe, folder):
    """Heights of a recipe's surface on a square grid around its part."""
    file = folder / "sag.csv"
    subprocess.run([program, "sag", recipe, "--grid", "301", "-o", file], check=True,
                   stdout=subprocess.DEVNULL)
    return np.loadtxt(file, delimiter=",", skiprows=1)[:, :3].T


def row(name, points, pitch, surface, path):
    return f"| {name} | {points} | {pitch} | {surface} | {path['max']:.3g} | {path['rms']:.3g} |"


def rows(program, name, side, folder):
    text = (ROOT / f"docs/recipes/{name}.toml").read_text()
    # Only the table is wanted, no motion program.
    text = re.sub(r"(?s)\[output\].*?(?=\n\[|\Z)", "", text)
    formula = folder / "formula.toml"
    formula.write_text(text)
    recipe = Recipe(tomllib.loads(text))
    measure = lambda path: interpolation_error(recipe, path, instants=12)
    yield row(name, "the formula", "", "", measure(run(program, formula, folder / "formula")))
    for count in SIZES:
        pitch = grid(recipe.sag, side, count, folder / f"{count}.DAT")
        of_grid = re.sub(r"(?s)\[surface\].*?(?=\n\[)",
                         f'[surface]\nuse = "grid-sag"\nfile = "{count}.DAT"\n', text)
        file = folder / f"{count}.toml"
        file.write_text(of_grid)
        x, y, z = sags(program, file, folder)
        on_part = np.hypot(x, y) <= recipe.part_radius
        surface = np.abs(z - recipe.sag(x, y))[on_part].max() * NM_PER_MM
        path = measure(run(program, file, folder / str(count)))
        yield row(name, f"{count}²", f"{pitch * 1e3:.1f} µm", f"{surface:.2g}", path)


def main():
    program = Path(sys.argv[1]).resolve()
    lines = [BEGIN,
             "| part | points | pitch | surface, largest error (nm) | path, largest error (nm) | path, RMS (nm) |",
             "|---|---|---|---|---|---|"]
    with tempfile.TemporaryDirectory() as folder:
        for name, side in PARTS:
            for line in rows(program, name, side, Path(folder)):
                print(line, flush=True)
                lines.append(line)
    page = PAGE.read_text()
    table = re.escape(BEGIN) + r"\n(\|.*\n)*"
    assert re.search(table, page), f"{PAGE} has no line {BEGIN}"
    PAGE.write_text(re.sub(table, lambda _: "\n".join(lines) + "\n", page))


if __name__ == "__main__":
    main()
