"""Writes composites.json: a sum of the surfaces in series.py, plain and in two poses, by mpmath.

The surfaces are the textbook formulas of series.py, each moved, turned, scaled and lifted. The sum
is turned by the rotation matrices of ../poses.py, whose Newton's iteration finds the point that
comes to lie above (x, y). Derivatives are numerical, of 60 digits or more.

A case: the surfaces of the sum with their places, the pose or null, and z(t), zx(t), zy(t) along the
curve x(t), y(t), all as Taylor coefficients 0 to 4.

Run: python composites.py > composites.json
"""

import json
import sys
from pathlib import Path

import mpmath
from mpmath import cos, mpf, sin

import series

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))
import poses  # noqa: E402

PLAIN = {"scale": 1.0, "decentre_x": 0.0, "decentre_y": 0.0, "clocking": 0.0, "piston": 0.0}
SUM = [
    {"surface": "conic", "params": {"radius": 150.0, "conic": -1.0}, "place": PLAIN},
    {"surface": "zernike",
     "params": {"indexing": "noll", "normalization_radius": 12.0,
                "coefficients": {"5": 0.0012, "7": -0.0008, "11": 0.0004, "14": 0.0003}},
     "place": {**PLAIN, "scale": -0.5, "decentre_x": 20.0, "decentre_y": -3.0,
               "clocking": 0.6875}},
    {"surface": "forbes-q2d",
     "params": {"normalization_radius": 15.0, "coefficients": {"0,2": 0.01, "3,-1": 0.002,
                                                               "1,0": -0.004}},
     "place": {**PLAIN, "decentre_x": 18.0, "clocking": -0.25, "piston": 0.25}},
    {"surface": "odd-asphere", "params": {"coefficients": {"3": 2e-6, "5": -1e-9}},
     "place": PLAIN},
]
POSES = [None, dict(x=20.0, y=-2.0, level=True), dict(x=17.0, y=1.0, tilt_x=0.125, tilt_y=-0.1875)]
CURVES = [
    ([0.0, 0.75, -0.25, 0.125, 0.0625], [0.0, -0.5, 0.375, -0.0625, 0.03125]),
    ([3.5, -0.3125, 0.5, 0.1875, -0.25], [-2.25, 0.875, 0.125, -0.375, 0.09375]),
    ([-6.0, 0.5, 0.25, 0.0, 0.125], [4.75, 1.0, -0.25, 0.5, 0.0]),
]


def conic(p, x, y):
    return series.conicoid(x * x + y * y, p["radius"], p["conic"])


def sag(surfaces, x, y):
    total = mpf(0)
    for one in surfaces:
        name = one["surface"].replace("-", "_")
        formula = conic if name == "conic" else getattr(series, name)
        place = series.exact(one["place"])
        u, v = x - place["decentre_x"], y - place["decentre_y"]
        turn = place["clocking"]
        u, v = cos(turn) * u + sin(turn) * v, cos(turn) * v - sin(turn) * u
        total += place["scale"] * formula(series.exact(one["params"]), u, v) + place["piston"]
    return total


poses.sag = sag


def cases():
    for pose in POSES:
        with mpmath.workdps(140):
            turned = poses.rotation(SUM, pose) if pose else None
        for x, y in CURVES:
            # Without a pose the curves lie in the frame of the sum, where its middle is.
            x = x if pose else [x[0] + 20.0, *x[1:]]

            def at(t, x=x, y=y):
                u, v = (mpmath.polyval([mpf(c) for c in reversed(line)], t) for line in (x, y))
                if pose:
                    return poses.posed(SUM, pose, turned, u, v)
                return (sag(SUM, u, v), *poses.slopes(SUM, u, v))

            z, zx, zy = poses.expansion(at)
            yield {"sum": SUM, "pose": pose, "x": x, "y": y, "z": z, "zx": zx, "zy": zy}


if __name__ == "__main__":
    made = {"script": "tests/reference/surfaces/composites.py",
            "packages": f"mpmath {mpmath.__version__}"}
    lines = ",\n".join(json.dumps(case) for case in cases())
    print(f'{{"made_by": {json.dumps(made)}, "cases": [\n{lines}\n]}}')
