"""Nose centres by opencamlib's drop-cutter, for tests/reference/dropcutter.json.

The nose is a circle in the radial plane, opencamlib's tool a ball. The two touch alike where the
surface does not change across that plane, so for each angle the radial section z = g(theta, rho)
is extruded across it: a strip of two triangles a step of rho. The ball of the nose's radius is
dropped on the strip at y = 0, and meets it highest there, in the plane. Its tip is lowered, so
the centre is one radius above what opencamlib gives.

What the numbers are good for, without looking at any result:

- mesh_error_mm. The strip is the section's chord polygon p, with |p - g| <= h^2/8 max|g''|
  (Lagrange's remainder of linear interpolation). The height of the centre is max over s of
  g(s) + sqrt(R^2 - (s - X)^2): two sections that differ by at most e everywhere give heights that
  differ by at most e, whatever their slopes and whether or not the nose fits. A second difference
  of the heights is h^2 g'' somewhere within two steps of every place between them; twice the
  largest third difference covers by how much more g'' may be at that place.
- rounding_mm. Heights of the section carry some roundings of the largest length in their formula,
  and the drop some more. opencamlib takes a facet whose normal lies within 1e-7 of the vertical
  for flat at the height of one corner: 1e-7 h.

Surfaces are the textbook formulas of playback/surfaces.py, with the parameters of docs/recipes.
One more surface has hollows that the nose is too large for, `fits` false: there it rides on two
flanks, and only a search for the first touch is right.

    python dropcutter.py > dropcutter.json        # needs numpy and opencamlib; made with 2023.1.11
"""

import json
import math
import sys
import tomllib
from pathlib import Path

import numpy as np
import opencamlib as ocl

HERE = Path(__file__).parent
RECIPES = HERE.parents[1] / "docs" / "recipes"
sys.path.insert(0, str(HERE / "playback"))

from surfaces import LENGTH_MM, PER_LENGTH, SURFACES, quantity  # noqa: E402

# The recipe, and the largest length in the surface's formula, mm.
PARTS = [
    ("astigmatic-5mm", 5),
    ("sinusoidal-array-10mm", 10),
    ("toric-40mm", 200),
    ("off-axis-paraboloid-50mm", 2000),
    ("xy-polynomial-20mm", 20),
]
# Hollows of radius 1/(A (2 pi f)^2) = 0.51 mm for a nose of 1 mm.
TOO_NARROW = {
    "part": {"aperture": "6 mm"},
    "surface": {"use": "sinusoidal-array", "amplitude_x": "0.05 mm", "frequency_x": "1 /mm",
                "frequency_y": "1 /mm", "form": "product"},
    "tool": {"nose_radius": "1 mm"},
}

ANGLES = [0.0, 0.4, math.pi / 4, 1.9, 3.3, 5.6]
PLACES = 48
# The first place, beyond the axis, mm; the last lies half a nose radius beyond the rim.
FIRST = -0.2
# Chord errors aimed at, mm; a flat section gets the longest steps.
CHORD_ERROR = 1e-9
LONGEST_STEP = 0.01
# The strip reaches this many steps to either side of the radial plane, which keeps its triangles
# from being slivers.
HALF_WIDTH = 2.0
# From below every part, mm.
BELOW = -1e4
ROUNDINGS = 8
FLAT = 1e-7
EPSILON = np.finfo(float).eps


def parameters(table):
    """The surface's parameters as plain numbers, lengths in mm."""
    plain = {}
    for name, value in table.items():
        if name not in ("use", "form", "terms"):
            value = quantity(table, name, LENGTH_MM | PER_LENGTH)
        if name != "use":
            plain[name] = value
    return plain


def section_of(sag, theta):
    """g(theta, rho) over arrays of rho."""
    cos, sin = math.cos(theta), math.sin(theta)
    return lambda rho: sag(rho * cos, rho * sin) + 0 * rho


def chord_error(heights):
    """Largest distance of the section from the chords between these heights at equal steps."""
    second, third = np.diff(heights, 2), np.diff(heights, 3)
    return (np.abs(second).max() + 2 * np.abs(third).max()) / 8


def vertices(section, low, high):
    """Places and heights of the mesh, fine enough for CHORD_ERROR."""
    steps = math.ceil((high - low) / LONGEST_STEP)
    coarse = chord_error(section(np.linspace(low, high, steps + 1)))
    if coarse > CHORD_ERROR:
        steps = math.ceil(steps * math.sqrt(coarse / CHORD_ERROR))
    rho = np.linspace(low, high, steps + 1)
    return rho, section(rho)


def strip(rho, heights):
    """The section extruded to either side of y = 0."""
    width = HALF_WIDTH * (rho[1] - rho[0])
    near = [ocl.Point(x, -width, z) for x, z in zip(rho, heights)]
    far = [ocl.Point(x, width, z) for x, z in zip(rho, heights)]
    surface = ocl.STLSurf()
    for i in range(len(rho) - 1):
        surface.addTriangle(ocl.Triangle(near[i], near[i + 1], far[i + 1]))
        surface.addTriangle(ocl.Triangle(near[i], far[i + 1], far[i]))
    return surface


def drop(surface, radius, places):
    """Z of the ball's centre at each place."""
    cutter = ocl.BallCutter(2 * radius, 10 * radius)
    batch = ocl.BatchDropCutter()
    batch.setSTL(surface)
    batch.setCutter(cutter)
    for x in places:
        batch.appendPoint(ocl.CLPoint(x, 0, BELOW))
    batch.run()
    found = batch.getCLPoints()
    assert [point.x for point in found] == list(places)
    return [point.z + radius for point in found]


def measure(section, radius, places, formula_length):
    """Centres, mesh error and rounding."""
    margin = radius + 2 * LONGEST_STEP
    rho, heights = vertices(section, places[0] - margin, places[-1] + margin)
    step = rho[1] - rho[0]
    rounding = ROUNDINGS * EPSILON * formula_length + FLAT * step
    return drop(strip(rho, heights), radius, places), chord_error(heights), rounding


def case(recipe, theta, formula_length, fits):
    """One angle of one part, as it is written."""
    table = recipe["surface"]
    radius = quantity(recipe["tool"], "nose_radius", LENGTH_MM)
    rim = quantity(recipe["part"], "aperture", LENGTH_MM) / 2
    places = np.linspace(FIRST, rim + radius / 2, PLACES).round(4).tolist()
    section = section_of(SURFACES[table["use"]](table), theta)
    z, mesh_error, rounding = measure(section, radius, places, formula_length)
    return {
        "surface": table["use"], "parameters": parameters(table), "aperture_radius_mm": rim,
        "tool": {"nose_radius_mm": radius}, "fits": fits, "theta": theta,
        "mesh_error_mm": mesh_error, "rounding_mm": rounding, "x": places, "z_centre": z,
    }


def check():
    """The drop and its stated errors against closed forms: planes, a hollow, a dome."""
    radius, places = 1.0, np.linspace(-1.5, 1.5, 31).tolist()
    for slope in (0.0, 1e-8, -0.3, 0.7):
        exact = [slope * x + radius * math.hypot(1, slope) for x in places]
        measured = measure(lambda rho: slope * rho, radius, places, 1)
        compare(measured, exact, f"plane of slope {slope}")
    for sign in (1, -1):
        exact = [sign * (5 - math.sqrt((5 - sign * radius) ** 2 - x * x)) for x in places]
        measured = measure(lambda rho: sign * (5 - np.sqrt(25 - rho**2)), radius, places, 5)
        compare(measured, exact, f"arc of radius {5 * sign}")


def compare(measured, exact, what):
    z, mesh_error, rounding = measured
    worst = max(abs(a - b) for a, b in zip(z, exact))
    print(f"{what}: {worst:.2e} of {mesh_error:.2e} + {rounding:.2e} mm", file=sys.stderr)
    assert worst <= mesh_error + rounding, what


def cases():
    for name, formula_length in PARTS:
        recipe = tomllib.loads((RECIPES / f"{name}.toml").read_text(encoding="utf-8"))
        for theta in ANGLES:
            yield case(recipe, theta, formula_length, True)
    for theta in ANGLES[1:]:  # along x the product is flat
        yield case(TOO_NARROW, theta, 6, False)


if __name__ == "__main__":
    check()
    lines = [json.dumps(one) for one in cases()]
    print('{"cases": [\n' + ",\n".join(lines) + "\n]}")
