#!/usr/bin/env python3
"""A part that is corrected by its own measured error, for docs/maps.md.

    correction.py TURNPATH [MAP.gsf]            # needs numpy

AST-5 was cut, measured, and found to be off by 200 nm PV. The map of the error has 2 nm RMS of noise
and a disc of data. A recipe takes the map away from the wanted surface: `scale = -1`, `smooth`. The
machine is taken to make the same error again. playback.py finds the machined surface from the rows of
`toolpath.csv`: with the error it must be the wanted surface.

With MAP.gsf the map alone is written.
"""

import json
import math
import subprocess
import sys
import tempfile
import tomllib
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "tests/reference/playback"))

from playback import Recipe, ToolPath, interpolation_error, surface_error  # noqa: E402

RADIUS = 2.5  # of the part, mm
SIDE, COUNT = 5.3, 212  # of the map: pixels of 25 µm
PV = 200e-6  # mm
NOISE = 2e-6  # mm RMS
SMOOTH = "0.3 mm"

RECIPE = """
format = 1
name = "AST-5, corrected"

[part]
aperture = "5 mm"

[[surface]]
use = "astigmatic"
k = "0.08 /mm"

[[surface]]
use = "grid-sag"
file = "{map}"
scale = -1
smooth = "{smooth}"

[tool]
nose_radius = "1 mm"
included_angle = "120 deg"
clearance_angle = "30 deg"

[tolerance]
interpolation = "20 nm"
residual = "20 nm"

[spindle]
speed = "500 rpm"

[feed]
use = "atpg"

[sampler]
use = "atpg"

[compensator]
use = "z-direction"

[velocity]
use = "triangle-rotary"
"""


def shape(x, y):
    """What a machine does: astigmatism, trefoil, a zone, a wave; not yet scaled."""
    u, v = x / RADIUS, y / RADIUS
    q = u * u + v * v
    zone = q * q - q
    return (0.5 * (u * u - v * v) + 0.35 * (u**3 - 3 * u * v * v) + 0.8 * zone
            + 0.08 * np.sin(2 * math.pi * 1.3 * u + 0.4) * np.cos(2 * math.pi * 0.9 * v))


def scale():
    """The factor that makes the error 200 nm PV on the part."""
    s = np.linspace(-RADIUS, RADIUS, 801)
    x, y = np.meshgrid(s, s)
    on_part = shape(x, y)[np.hypot(x, y) <= RADIUS]
    return PV / (on_part.max() - on_part.min())


def write_map(file, error):
    """Gwyddion Simple Field in metres: rows from the top, NaN beyond the disc."""
    place = SIDE / COUNT * (np.arange(COUNT) - 0.5 * (COUNT - 1))
    x, y = np.meshgrid(place, place[::-1])
    noise = np.random.default_rng(7).normal(0, NOISE, x.shape)
    heights = np.where(np.hypot(x, y) <= RADIUS + 0.03, error(x, y) + noise, np.nan)
    # A grain of dust.
    heights[np.hypot(x - 0.8, y + 0.5) < 0.06] = np.nan
    header = (f"Gwyddion Simple Field 1.0\nXRes = {COUNT}\nYRes = {COUNT}\n"
              f"XReal = {SIDE * 1e-3:.9e}\nYReal = {SIDE * 1e-3:.9e}\n"
              "Title = measured minus wanted\nXYUnits = m\nZUnits = m\n").encode()
    data = header + b"\0" * (4 - len(header) % 4) + (heights * 1e-3).astype("<f4").tobytes()
    Path(file).write_bytes(data)


def main():
    factor = scale()
    error = lambda x, y: factor * shape(x, y)
    if len(sys.argv) > 2:
        return write_map(sys.argv[2], error)
    program = Path(sys.argv[1]).resolve()
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        write_map(folder / "error.gsf", error)
        text = RECIPE.format(map="error.gsf", smooth=SMOOTH)
        (folder / "recipe.toml").write_text(text)
        said = subprocess.run([program, "run", folder / "recipe.toml", "-o", folder / "out"],
                              stdout=subprocess.PIPE, text=True)
        remarks = [line.strip() for line in said.stdout.splitlines() if "remark" in line]
        path = ToolPath.read(folder / "out/toolpath.csv")
    table = tomllib.loads(text)
    table["surface"] = table["surface"][:1]
    recipe = Recipe(table)
    wanted = recipe.sag
    # Machined + error − wanted is machined − (wanted − error).
    recipe.sag = lambda x, y: wanted(x, y) - error(x, y)
    figures = {
        "status": said.returncode,
        "remarks": remarks,
        "machined_plus_error_minus_wanted_nm": surface_error(recipe, path, 60),
        "played_minus_true_nm": interpolation_error(recipe, path, instants=8),
    }
    recipe.sag = wanted
    figures["without_the_error_nm"] = surface_error(recipe, path, 20)
    print(json.dumps(figures, indent=2))
    if said.returncode != 0:
        raise SystemExit(f"the run ended with status {said.returncode}")
    rms = figures["machined_plus_error_minus_wanted_nm"]["rms"]
    if rms > 15:
        raise SystemExit(f"{rms} nm RMS are left")
    return None


if __name__ == "__main__":
    main()
