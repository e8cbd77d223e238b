"""Writes series.json: order-4 series of the elementary functions, to 50 digits, by mpmath.

Each outer function is applied to an inner series a(t) (for two arguments: a(t), b(t)) whose
coefficients are exact doubles. The reference is mpmath's numerical Taylor expansion of the
composed function at 0, which knows nothing of the recurrences that are under test.

Run: python series.py > series.json
"""

import json

import mpmath
from mpmath import mp, mpf

mp.dps = 50
ORDER = 4

SHAPES = [
    [0.75, -0.5, 0.3125, 1.25],
    [-1.5, 2.0, -0.625, 0.1875],
]
SECOND = [0.875, 0.25, -0.5, 0.375]


def polynomial(coefficients):
    exact = [mpf(c) for c in coefficients]
    return lambda t: mpmath.polyval(exact[::-1], t)


def expansion(function):
    """Taylor coefficients 0 to 4 by differentiation at a working precision of 100 digits."""
    with mpmath.workdps(100):
        return mpmath.taylor(function, 0, ORDER)


FUNCTIONS = {
    "recip": (lambda u: 1 / u, [0.3, -2.7, 41.5]),
    "sqrt": (mpmath.sqrt, [0.04, 1.7, 523.0]),
    "exp": (mpmath.exp, [-3.3, 0.0, 2.1]),
    "ln": (mpmath.log, [0.2, 1.3, 70.0]),
    "sin": (mpmath.sin, [-7.1, 0.4, 30.0]),
    "cos": (mpmath.cos, [-7.1, 0.4, 30.0]),
    "tan": (mpmath.tan, [-1.1, 0.3, 2.5]),
    "asin": (mpmath.asin, [-0.9, 0.2, 0.7]),
    "acos": (mpmath.acos, [-0.9, 0.2, 0.7]),
    "atan": (mpmath.atan, [-4.0, 0.3, 1.9]),
    "sinh": (mpmath.sinh, [-2.2, 0.5, 6.0]),
    "cosh": (mpmath.cosh, [-2.2, 0.5, 6.0]),
    "tanh": (mpmath.tanh, [-2.2, 0.5, 6.0]),
    "powf 2.5": (lambda u: u ** mpf("2.5"), [0.3, 1.0, 8.5]),
    "powf -0.75": (lambda u: u ** mpf("-0.75"), [0.3, 1.0, 8.5]),
    "powi 5": (lambda u: u**5, [-1.2, 0.0, 2.3]),
    "powi -3": (lambda u: u**-3, [-1.2, 0.6, 2.3]),
    "abs": (lambda u: mpmath.sign(u) * u, [-1.2, 0.6]),
}

PAIRS = {
    "div": (lambda u, v: u / v, [(1.3, -0.7), (0.0, 2.3)]),
    "mul": (lambda u, v: u * v, [(1.3, -0.7), (0.0, 2.3)]),
    "hypot": (lambda u, v: mpmath.sqrt(u * u + v * v), [(3.0, -4.1), (0.0, 0.3)]),
    "atan2": (mpmath.atan2, [(0.8, 1.1), (2.0, -0.4), (-0.9, -3.0)]),
}


def doubles(series):
    return [float(c) for c in series]


def cases():
    for name, (function, points) in FUNCTIONS.items():
        for point in points:
            for shape in SHAPES:
                a = [point, *shape]
                inner = polynomial(a)
                out = expansion(lambda t: function(inner(t)))
                yield {"function": name, "a": a, "out": doubles(out)}
    for name, (function, points) in PAIRS.items():
        for first, second in points:
            for shape in SHAPES:
                a, b = [first, *shape], [second, *SECOND]
                u, v = polynomial(a), polynomial(b)
                out = expansion(lambda t: function(u(t), v(t)))
                yield {"function": name, "a": a, "b": b, "out": doubles(out)}


made = {"script": "tests/reference/series.py", "packages": f"mpmath {mpmath.__version__}"}
lines = ",\n".join(json.dumps(case) for case in cases())
print(f'{{"made_by": {json.dumps(made)}, "cases": [\n{lines}\n]}}')
