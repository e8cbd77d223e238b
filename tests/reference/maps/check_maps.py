#!/usr/bin/env python3
"""Maps of turnpath read by an independent reader and held against brute force.

    check_maps.py TURNPATH [RECIPE.toml …]      without a recipe: three of docs/recipes

Runs each recipe with a `.gsf` and a `.xyz` map. The `.gsf` is read twice: by the package gsffile
(PyPI) and here, from the format's description (gwyddion.net, user guide, "Simple Field Files").
Both must agree bit for bit, with the `.xyz`, and, at cells chosen at random, with the lowest of
the nose's circles that ../playback/playback.py finds on toolpath.csv.

The grids that `sag` writes are read too: the `.gsf` by the same readers, the Zemax `.DAT` from its
description (`nx ny delx dely unitflag xdec ydec`, then lines `z dz/dx dz/dy d2z/dxdy nodata` from
the upper left point on). Both must have the heights and the places of the CSV. Exit 1 on a miss.
"""

import math
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
from gsffile import read_gsf

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "playback"))
from playback import Recipe, ToolPath, line_error  # noqa: E402

RECIPES = HERE.parents[2] / "docs" / "recipes"
CHOSEN = ("astigmatic-5mm", "sinusoidal-array-10mm", "xy-polynomial-20mm")
SIZE = 300
CELLS = 200  # compared with brute force
LARGEST_DIFFERENCE_M = 2e-12  # a part of 1e-7 of what a float holds, and rounding


def by_description(path):
    """Header fields and data of a `.gsf`: text lines, 1 to 4 NULs to a multiple of 4, floats."""
    content = path.read_bytes()
    magic, rest = content.split(b"\n", 1)
    assert magic == b"Gwyddion Simple Field 1.0", magic
    header = rest.split(b"\0", 1)[0]
    end = len(magic) + 1 + len(header)
    start = end + 4 - end % 4
    assert content[end:start].strip(b"\0") == b"" and 1 <= start - end <= 4
    fields = dict(line.split("=", 1) for line in header.decode("utf-8").splitlines())
    fields = {key.strip(): value.strip() for key, value in fields.items()}
    shape = int(fields["YRes"]), int(fields["XRes"])
    return fields, np.frombuffer(content[start:], dtype="<f4").reshape(shape)


def places(fields):
    """x and y of the cells' middles in m; the first row is the top."""
    count, side = int(fields["XRes"]), float(fields["XReal"])
    at = (np.arange(count) + 0.5) / count * side + float(fields["XOffset"])
    return np.meshgrid(at, at[::-1])


def check(program, recipe):
    """All comparisons of one recipe; gives the largest difference from brute force, m."""
    with tempfile.TemporaryDirectory() as folder:
        folder = Path(folder)
        call = [program, "run", recipe, "--map-size", str(SIZE)]
        # A second run into one folder removes the map of the first.
        for name in ("gsf", "xyz"):
            words = ["-o", folder / name, "--map", f"map.{name}"]
            run = subprocess.run([*call, *words], capture_output=True, text=True)
            assert run.returncode in (0, 1), run.stderr
        fields, data = by_description(folder / "gsf" / "map.gsf")
        by_package, _ = read_gsf(folder / "gsf" / "map.gsf")
        assert np.array_equal(data, by_package, equal_nan=True)
        x, y = places(fields)
        on_part = ~np.isnan(data)
        lines = np.loadtxt(folder / "xyz" / "map.xyz")
        assert np.allclose(lines[:, 0], x[on_part], rtol=1e-8, atol=1e-13)
        assert np.allclose(lines[:, 1], y[on_part], rtol=1e-8, atol=1e-13)
        assert np.allclose(lines[:, 2], data[on_part], rtol=1e-5, atol=1e-18)
        path, wanted = ToolPath.read(folder / "xyz" / "toolpath.csv"), Recipe.read(recipe)
        cells = np.argwhere(on_part)
        chosen = np.random.default_rng(1).choice(len(cells), CELLS, replace=False)
        worst = 0.0
        for row, column in cells[chosen]:
            at = 1e3 * x[row, column], 1e3 * y[row, column]
            angle = math.degrees(math.atan2(at[1], at[0]))
            expected = 1e-3 * line_error(wanted, path, angle, np.array([math.hypot(*at)]))[0]
            difference = abs(float(data[row, column]) - expected)
            assert difference <= LARGEST_DIFFERENCE_M + 1e-6 * abs(expected), (at, expected)
            worst = max(worst, difference)
        return worst


def by_header(path):
    """x, y and heights of a Zemax grid sag file, mm; the first row is the top."""
    header, *lines = path.read_text().splitlines()
    nx, ny, dx, dy, flag, x0, y0 = header.split()
    nx, ny = int(nx), int(ny)
    assert flag == "0", flag
    values = np.array([[float(word) for word in line.split()] for line in lines])
    assert values.shape == (nx * ny, 5)
    z = np.where(values[:, 4] == 1, np.nan, values[:, 0]).reshape(ny, nx)
    x = (np.arange(nx) - (nx - 1) / 2) * float(dx) + float(x0)
    y = ((ny - 1) / 2 - np.arange(ny)) * float(dy) + float(y0)
    return *np.meshgrid(x, y), z


def check_sag(program, recipe):
    """The grids of `sag` in all forms; gives the largest difference of a `.gsf`, mm."""
    with tempfile.TemporaryDirectory() as folder:
        folder = Path(folder)
        for name in ("sag.csv", "sag.gsf", "sag.DAT"):
            call = [program, "sag", recipe, "--grid", "41", "-o", folder / name]
            subprocess.run(call, check=True)
        rows = np.genfromtxt(folder / "sag.csv", delimiter=",", skip_header=1)
        # Rows of the CSV go up.
        x, y, z = (rows[:, k].reshape(41, 41)[::-1] for k in range(3))
        fields, data = by_description(folder / "sag.gsf")
        by_package, _ = read_gsf(folder / "sag.gsf")
        assert np.array_equal(data, by_package, equal_nan=True)
        for found, wanted in zip(places(fields), (x, y)):
            assert np.allclose(1e3 * found, wanted, rtol=0, atol=1e-12)
        assert np.allclose(1e3 * data.astype(float), z, rtol=6.1e-8, atol=1e-15, equal_nan=True)
        for found, wanted in zip(by_header(folder / "sag.DAT"), (x, y, z)):
            assert np.allclose(found, wanted, rtol=0, atol=1e-12, equal_nan=True)
        return float(np.nanmax(np.abs(1e3 * data.astype(float) - z)))


def main():
    """Command line."""
    if len(sys.argv) < 2:
        raise SystemExit(__doc__)
    program = str(Path(sys.argv[1]).resolve())
    recipes = [Path(name) for name in sys.argv[2:]] or [RECIPES / f"{one}.toml" for one in CHOSEN]
    for recipe in recipes:
        print(f"{recipe.stem}: {CELLS} cells within {check(program, recipe) * 1e9:.1e} nm")
        print(f"{recipe.stem}: the .gsf of sag within {check_sag(program, recipe) * 1e6:.1e} nm")


if __name__ == "__main__":
    main()
