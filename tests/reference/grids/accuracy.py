#!/usr/bin/env python3
"""The path over a grid of a known surface, against the surface itself: the table of docs/maps.md.

    accuracy.py TURNPATH            # needs numpy

Two parts: an asphere with a ripple at an interpolation tolerance of 1 nm, and the ready recipe of the
sinusoidal array. A recipe gets its surface replaced by a grid of it, of 64, 256 and 1024 points along
a side, in the format of Zemax with all digits; and the ripple by a disc of 256 points across with
holes. The program runs it, and playback.py measures the path against the formula. The first row of
each part is the path over the formula.
"""

import math
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
SIZES = [64, 256, 1024]
# The asphere: a radius of 60 mm, 2e-5 mm of the 4th power, a ripple of 100 nm every 0.4 mm.
CURVATURE, FOURTH, RIPPLE, PERIOD = 1 / 60, 2e-5, 1e-4, 0.4
ASPHERE = f"""[surface]
use = "formula"
z = "c*rho^2/(1 + sqrt(1 - c^2*rho^2)) + A*rho^4 + a*cos(2*pi*x/p)*cos(2*pi*y/p)"
constants = {{ c = "{CURVATURE!r} /mm", A = "{FOURTH!r} /mm^3", a = "{RIPPLE!r} mm", p = "{PERIOD} mm" }}
"""
# Holes of the disc: middle and radius, mm.
HOLES = [(1.1, 0.4, 0.05), (-0.3, -1.6, 0.1)]
DISC = 2.65  # mm
HOLED_SIZE = 256


def asphere(x, y):
    square = x * x + y * y
    conic = CURVATURE * square / (1 + np.sqrt(1 - CURVATURE**2 * square))
    wave = 2 * math.pi / PERIOD
    return conic + FOURTH * square * square + RIPPLE * np.cos(wave * x) * np.cos(wave * y)


def everywhere(x, y):
    return np.full(x.shape, True)


def holed(x, y):
    holes = [np.hypot(x - a, y - b) < radius for a, b, radius in HOLES]
    return (np.hypot(x, y) <= DISC) & ~np.any(holes, axis=0)


def grid(sag, has_height, side, count, file):
    pitch = side / (count - 1)
    place = pitch * (np.arange(count) - 0.5 * (count - 1))
    with open(file, "w") as text:
        text.write(f"{count} {count} {pitch!r} {pitch!r} 0 0 0\n")
        for y in place[::-1]:
            there = has_height(place, np.full(place.shape, y))
            text.writelines(f"{float(z)!r} 0 0 0 {0 if known else 1}\n"
                            for z, known in zip(sag(place, y), there))
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


def ready(name):
    """A ready recipe; only the table is wanted, no motion program."""
    text = (ROOT / f"docs/recipes/{name}.toml").read_text()
    return re.sub(r"(?s)\[output\].*?(?=\n\[|\Z)", "", text)


def with_surface(text, surface):
    return re.sub(r"(?s)\[surface\].*?(?=\n\[)", lambda _: surface, text)


def array():
    text = ready("sinusoidal-array-10mm")
    recipe = Recipe(tomllib.loads(text))
    grids = [(f"{count}²", count, everywhere) for count in SIZES]
    return "sinusoidal-array-10mm", text, recipe, 10.6, grids


def rippled():
    text = ready("astigmatic-5mm")
    recipe = Recipe(tomllib.loads(text))
    recipe.sag = asphere
    text = text.replace('interpolation = "100 nm"', 'interpolation = "1 nm"')
    grids = [(f"{count}²", count, everywhere) for count in SIZES]
    grids.append((f"{HOLED_SIZE}², a disc with holes", HOLED_SIZE, holed))
    return "rippled asphere, 5 mm", with_surface(text, ASPHERE), recipe, 5.4, grids


def rows(program, part, folder):
    name, text, recipe, side, grids = part
    formula = folder / "formula.toml"
    formula.write_text(text)
    measure = lambda path: interpolation_error(recipe, path, instants=12)
    yield row(name, "the formula", "", "", measure(run(program, formula, folder / "formula")))
    for number, (points, count, has_height) in enumerate(grids):
        pitch = grid(recipe.sag, has_height, side, count, folder / f"{number}.DAT")
        file = folder / f"{number}.toml"
        surface = f'[surface]\nuse = "grid-sag"\nfile = "{number}.DAT"\n'
        file.write_text(with_surface(text, surface))
        x, y, z = sags(program, file, folder)
        on_part = np.hypot(x, y) <= recipe.part_radius
        surface = np.abs(z - recipe.sag(x, y))[on_part].max() * NM_PER_MM
        path = measure(run(program, file, folder / str(number)))
        yield row(name, points, f"{pitch * 1e3:.1f} µm", f"{surface:.2g}", path)


def main():
    program = Path(sys.argv[1]).resolve()
    lines = [BEGIN,
             "| part | points | pitch | surface, largest error (nm) | path, largest error (nm) | path, RMS (nm) |",
             "|---|---|---|---|---|---|"]
    with tempfile.TemporaryDirectory() as folder:
        for part in [rippled(), array()]:
            for line in rows(program, part, Path(folder)):
                print(line, flush=True)
                lines.append(line)
    page = PAGE.read_text()
    table = re.escape(BEGIN) + r"\n(\|.*\n)*"
    assert re.search(table, page), f"{PAGE} has no line {BEGIN}"
    PAGE.write_text(re.sub(table, lambda _: "\n".join(lines) + "\n", page))


if __name__ == "__main__":
    main()
