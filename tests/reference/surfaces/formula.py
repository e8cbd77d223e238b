"""Writes formula.json: formulas with their slopes and order-4 series, by mpmath.

Each formula stands here twice: as a recipe has it, and in mpmath. rho and theta are mpmath's own
root and atan2. Derivatives are made as in series.py. At the axis, where mpmath's root and atan2 have no
derivatives, the second form has none of them: it is a polynomial in x and y instead.

Run: python formula.py > formula.json
"""

import json
import sys

import mpmath
from mpmath import mpf, atan2, cos, exp, hypot, log, sin, sqrt, tan, tanh, asin, acos, atan, sinh, cosh

from series import AGREED, DIGITS, SHAPES, STRIDE, doubles, expand

PLACES = [(0.37109375, -0.68359375), (-0.71875, 0.75)]


def rho(x, y):
    return hypot(x, y)


def theta(x, y):
    return atan2(y, x)


# The formula of a recipe, its constants as value and power of a length, and the same for mpmath.
FORMULAS = [
    ("c*rho^2/(1 + sqrt(1 - (1 + K)*c^2*rho^2)) + A4*rho^4 + A6*rho^6",
     {"c": [0.03125, -1], "K": [-0.75, 0], "A4": [1.5e-6, -3], "A6": [-2e-9, -5]},
     lambda k, x, y: k["c"] * rho(x, y) ** 2
     / (1 + sqrt(1 - (1 + k["K"]) * k["c"] ** 2 * rho(x, y) ** 2))
     + k["A4"] * rho(x, y) ** 4 + k["A6"] * rho(x, y) ** 6),
    ("R - sqrt((R - a + sqrt(a^2 - y^2))^2 - x^2)", {"R": [50, 1], "a": [32, 1]},
     lambda k, x, y: k["R"] - sqrt((k["R"] - k["a"] + sqrt(k["a"] ** 2 - y * y)) ** 2 - x * x)),
    ("A*cos(w*x)*exp(-(rho/s)^2) + A*sin(w*y)*tanh(x/s)",
     {"A": [0.0125, 1], "w": [0.75, -1], "s": [6.5, 1]},
     lambda k, x, y: k["A"] * cos(k["w"] * x) * exp(-(x * x + y * y) / k["s"] ** 2)
     + k["A"] * sin(k["w"] * y) * tanh(x / k["s"])),
    ("k*rho^2*(1 + 0.25*cos(2*theta)) + 0.5*k*rho^4/R^2*sin(4*(theta - t)) + A*cos(3*theta)",
     {"k": [0.002, -1], "R": [9, 1], "t": [0.3125, 0], "A": [0.01, 1]},
     lambda k, x, y: k["k"] * rho(x, y) ** 2 * (1 + cos(2 * theta(x, y)) / 4)
     + k["k"] / 2 * rho(x, y) ** 4 / k["R"] ** 2 * sin(4 * (theta(x, y) - k["t"]))
     + k["A"] * cos(3 * theta(x, y))),
    ("s*ln(2 + (x/s)^2) + s*atan(y/s) + s*asin(x/s)*acos(y/s) + s*tan(x*y/s^2/4)", {"s": [16, 1]},
     lambda k, x, y: k["s"] * (log(2 + (x / k["s"]) ** 2) + atan(y / k["s"])
                               + asin(x / k["s"]) * acos(y / k["s"])
                               + tan(x * y / k["s"] ** 2 / 4))),
    ("s*sinh(x/s)*cosh(y/s) + s*(2 + x/s)^1.5 + s*(3 + y/s)^-2 + s*atan2(y + 3*s, x - s)"
     " + hypot(x - s, y + 2*s)",
     {"s": [12, 1]},
     lambda k, x, y: k["s"] * (sinh(x / k["s"]) * cosh(y / k["s"]) + (2 + x / k["s"]) ** mpf("1.5")
                               + (3 + y / k["s"]) ** -2 + atan2(y + 3 * k["s"], x - k["s"]))
     + hypot(x - k["s"], y + 2 * k["s"])),
    ("abs(x - 40*mm)*rho/s + max(x, y)*rho^3/s^3 + min(x, 2*y)*y/s", {"s": [20, 1]},
     lambda k, x, y: (40 - x) * rho(x, y) / k["s"]
     + (x if x.real > y.real else y) * rho(x, y) ** 3 / k["s"] ** 3
     + (x if x.real < 2 * y.real else 2 * y) * y / k["s"]),
]
# The same at the axis.
AT_AXIS = [
    (FORMULAS[0][0], FORMULAS[0][1],
     lambda k, x, y: k["c"] * (x * x + y * y)
     / (1 + sqrt(1 - (1 + k["K"]) * k["c"] ** 2 * (x * x + y * y)))
     + k["A4"] * (x * x + y * y) ** 2 + k["A6"] * (x * x + y * y) ** 3),
    FORMULAS[1],
    FORMULAS[2],
    ("k*rho^2*(1 + 0.25*cos(2*theta)) + 0.5*k*rho^4/R^2*sin(4*(theta - t)) + k*rho^3/R*cos(3*theta)",
     {"k": [0.002, -1], "R": [9, 1], "t": [0.3125, 0]},
     lambda k, x, y: k["k"] * (x * x + y * y + (x * x - y * y) / 4)
     + k["k"] / 2 / k["R"] ** 2 * ((4 * x**3 * y - 4 * x * y**3) * cos(4 * k["t"])
                                   - (x**4 - 6 * x * x * y * y + y**4) * sin(4 * k["t"]))
     + k["k"] / k["R"] * (x**3 - 3 * x * y * y)),
    FORMULAS[4],
    FORMULAS[5],
]
APERTURE = 8.0


def cases():
    placed = [(formula, PLACES) for formula in FORMULAS]
    placed += [(formula, [(0.0, 0.0)]) for formula in AT_AXIS]
    for (text, constants, of), places in placed:
        values = {name: value for name, (value, _) in constants.items()}
        for place_x, place_y in places:
            for shape_x, shape_y in SHAPES:
                x = [APERTURE * place_x, *(STRIDE * APERTURE * c for c in shape_x)]
                y = [APERTURE * place_y, *(STRIDE * APERTURE * c for c in shape_y)]
                rough, fine = (
                    expand(of, values, [mpf(c) for c in x], [mpf(c) for c in y], digits)
                    for digits in DIGITS
                )
                for a, b in zip(sum(rough, []), sum(fine, [])):
                    assert abs(a - b) <= AGREED * max(1, abs(b)), (text, x, y)
                z, zx, zy = (doubles(series) for series in fine)
                print(text, place_x, file=sys.stderr)
                yield {"surface": "formula", "params": {"z": text, "constants": constants},
                       "x": x, "y": y, "z": z, "zx": zx, "zy": zy}


if __name__ == "__main__":
    made = {"script": "tests/reference/surfaces/formula.py",
            "packages": f"mpmath {mpmath.__version__}"}
    lines = ",\n".join(json.dumps(case) for case in cases())
    print(f'{{"made_by": {json.dumps(made)}, "cases": [\n{lines}\n]}}')
