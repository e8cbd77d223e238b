"""Writes ../../../docs/recipes/telescope-mirror.DAT: the segment of telescope-mirror.zmx, laid flat.

The height of a point is where the normal of the segment's middle, moved to that point, meets the
parent: optiland's even asphere, as its reader of .zmx has it, and scipy's root search. The map is
what a design program would export of the part as it stands on the machine: Zemax grid sag, in mm.

Needs optiland 0.6.3 and scipy 1.17. Run: python telescope.py
"""

import warnings
from pathlib import Path

import numpy as np
from scipy.optimize import brentq

warnings.filterwarnings("ignore")
from optiland.fileio.zemax.reader.converter import ZemaxToOpticConverter  # noqa: E402

RECIPES = Path(__file__).resolve().parents[3] / "docs" / "recipes"
SURFACE, MIDDLE, RADIUS, COUNT = 3, (0.0, 70.0), 30.0, 31
HEIGHT = 12.0  # no point of the part is this far from the plane of its middle, mm


def main():
    """The map, from the upper left point to the right, rows downwards."""
    design = ZemaxToOpticConverter({}).read(str(RECIPES / "telescope-mirror.zmx"))
    # Break of coordinates, which optiland folds into the others, is no surface there.
    geometry = design.surfaces[SURFACE - 1].geometry

    def parent(x, y):
        """The mirror as the tool sees it, from the side of -z of the design."""
        return -float(geometry.sag(-x, y))

    x0, y0 = -MIDDLE[0], MIDDLE[1]
    step = 1e-4
    slope = np.array([parent(x0 + step, y0) - parent(x0 - step, y0),
                      parent(x0, y0 + step) - parent(x0, y0 - step)]) / (2 * step)
    normal = np.array([-slope[0], -slope[1], 1.0])
    # The middle lies at x = 0, so the normal has no x. Rounding tilts it by 1e-12 rad or so.
    normal /= np.linalg.norm(normal)
    assert abs(slope[0]) < 1e-11
    cos, sin = normal[2], -normal[1]
    z0 = parent(x0, y0)

    def height(x, y):
        def miss(z):
            return z0 + sin * y + cos * z - parent(x0 + x, y0 + cos * y - sin * z)
        return brentq(miss, -HEIGHT, HEIGHT, xtol=1e-14, rtol=1e-14)

    pitch = 2 * RADIUS / (COUNT - 1)
    places = [pitch * k - RADIUS for k in range(COUNT)]
    lines = [f"{COUNT} {COUNT} {pitch} {pitch} 0 0 0"]
    for y in reversed(places):
        for x in places:
            inside = x * x + y * y <= (RADIUS + 1e-9) ** 2
            lines.append(f"{height(x, y):.12e} 0 0 0 0" if inside else "0 0 0 0 1")
    (RECIPES / "telescope-mirror.DAT").write_text("\n".join(lines) + "\n")


if __name__ == "__main__":
    main()
