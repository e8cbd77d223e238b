"""Writes series.json: the surfaces in models.py with their slopes and order-4 series, by mpmath.

Each surface is its textbook formula: Zernike polynomials by their factorials, Jacobi and Chebyshev
polynomials by mpmath's own functions, and Forbes' Q by what defines them: they are the powers of u²
made orthonormal in the mean square of their gradient, weighted by 1/sqrt(1 - u²), each positive at
the axis (Forbes 2007, 2010, 2012). A toroid is the curve turned, a segment off the axis is its
parent, turned, and met by Newton's iteration, a lens array has its nearest lattice points one by one.
Derivatives are mpmath's numerical ones, made twice, at 150 and 200 digits, which must agree to 50.

A case: z(t), zx(t), zy(t) along the curve x(t), y(t), all as Taylor coefficients 0 to 4. The
inputs are exact doubles; their first coefficients are also points for value and gradient. The
places are the axis, a point of the part, and one beyond the aperture.

Run: python series.py > series.json
"""

import functools
import json
import math
import sys
from fractions import Fraction

import mpmath
from mpmath import factorial, mpf, sqrt

from models import MODELS, numbers

ORDER = 4
DIGITS = (150, 200)
AGREED = mpf(10) ** -50
# The coefficients of the curves x(t) and y(t), times a quarter of the aperture.
SHAPES = [
    ([0.75, -0.25, 0.125, 0.0625], [-0.5, 0.375, -0.0625, 0.03125]),
    ([-0.3125, 0.5, 0.1875, -0.25], [0.875, 0.125, -0.375, 0.09375]),
]
STRIDE = 0.25
# Places, in units of the aperture's radius, away from the seams of the lens arrays.
PLACES = [(0.0, 0.0), (0.37109375, -0.68359375), (-0.71875, 0.75)]


def coefficients(p):
    return [(numbers(key), value) for key, value in p.get("coefficients", {}).items()]


def conicoid(square, radius, conic):
    if radius is None:
        return 0 * square
    return radius * square / (radius**2 * (1 + sqrt(1 - (1 + conic) * square / radius**2)))


def even_asphere(p, x, y):
    base = conicoid(x * x + y * y, p.get("radius"), p.get("conic", mpf(0)))
    return base + sum(a * (x * x + y * y) ** (i // 2) for (i,), a in coefficients(p))


def odd_asphere(p, x, y):
    base = conicoid(x * x + y * y, p.get("radius"), p.get("conic", mpf(0)))
    rho = sqrt(x * x + y * y)
    return base + sum(a * rho**i for (i,), a in coefficients(p))


def biconic(p, x, y):
    cx, cy = (1 / p[key] if key in p else mpf(0) for key in ("radius_x", "radius_y"))
    kx, ky = p.get("conic_x", mpf(0)), p.get("conic_y", mpf(0))
    root = sqrt(1 - (1 + kx) * cx**2 * x**2 - (1 + ky) * cy**2 * y**2)
    return (cx * x**2 + cy * y**2) / (1 + root)


def toroid_yz(p, x, y):
    u = conicoid(y * y, p.get("radius"), p.get("conic", mpf(0)))
    u += sum(a * y**i for (i,), a in coefficients(p))
    if "radius_rotation" not in p:
        return u
    far = p["radius_rotation"]
    return far - mpmath.sign(far) * sqrt((far - u) ** 2 - x * x)


def off_axis_conic(p, x, y):
    """The point of the parent on the segment's normal above (x, y)."""
    radius, conic, distance = p["vertex_radius"], p["conic"], p["off_axis_distance"]

    def slope_over_lever(square):
        return 1 / (radius * sqrt(1 - (1 + conic) * square / radius**2))

    height = conicoid(distance**2, radius, conic)
    steep = distance * slope_over_lever(distance**2)
    c = 1 / sqrt(1 + steep**2)
    s = c * steep
    z = mpf(0)
    for _ in range(60):
        across, up = distance + c * x - s * z, height + s * x + c * z
        square = across**2 + y * y
        miss = up - conicoid(square, radius, conic)
        step = miss / (c + s * across * slope_over_lever(square))
        z -= step
        if abs(step) <= mpf(10) ** (4 - mpmath.mp.dps):
            return z
    raise ArithmeticError("Newton's iteration does not settle")


def lenslet_array(p, x, y):
    pitch = p["pitch"]
    near_j = round(float(y / pitch) / (1 if p["layout"] == "square" else math.sqrt(3) / 2))
    near_i = round(float(x / pitch) - (0 if p["layout"] == "square" else near_j / 2))
    least = None
    for i in range(near_i - 2, near_i + 3):
        for j in range(near_j - 2, near_j + 3):
            u, v = i, j
            if p["layout"] == "hexagonal":
                u, v = i + mpf(j) / 2, sqrt(mpf(3)) / 2 * j
            square = (x - u * pitch) ** 2 + (y - v * pitch) ** 2
            least = square if least is None else min(least, square)
    return conicoid(least, p["radius"], p["conic"])


def xy_polynomial(p, x, y):
    r = p["normalization_radius"]
    return sum(c * (x / r) ** i * (y / r) ** j for (i, j), c in coefficients(p))


@functools.cache
def noll(number):
    """Degree and order by Noll's table: the orders grow, and even numbers are cosines."""
    degree = 0
    while number > (degree + 1) * (degree + 2) // 2:
        degree += 1
    place = number - degree * (degree + 1) // 2
    order = sorted(abs(m) for m in range(-degree, degree + 1, 2))[place - 1]
    return degree, order if number % 2 == 0 else -order


@functools.cache
def fringe(number):
    """Degree and order by the sum of both, then from the largest order down, cosine first."""
    listed = [(n, m) for n in range(60) for m in range(-n, n + 1, 2)]
    listed.sort(key=lambda one: (one[0] + abs(one[1]), -abs(one[1]), -one[1]))
    return listed[number - 1]


@functools.cache
def osa(number):
    listed = [(n, m) for n in range(30) for m in range(-n, n + 1, 2)]
    return listed[number]


def angular(order, x, y):
    """rho^|m| cos m theta, or the sine for m < 0."""
    power = mpmath.mpc(x, y) ** abs(order)
    return power.real if order >= 0 else power.imag


def zernike(p, x, y):
    r = p["normalization_radius"]
    x, y = x / r, y / r
    peak = p.get("normalization", "peak" if p["indexing"] == "fringe" else "rms") == "peak"
    total = mpf(0)
    for (number,), value in coefficients(p):
        n, m = {"noll": noll, "fringe": fringe, "osa": osa}[p["indexing"]](number)
        a = abs(m)
        radial = sum(
            (-1) ** k * factorial(n - k) * (x * x + y * y) ** ((n - a) // 2 - k)
            / (factorial(k) * factorial((n + a) // 2 - k) * factorial((n - a) // 2 - k))
            for k in range((n - a) // 2 + 1)
        )
        norm = 1 if peak else sqrt(mpf(n + 1) * (1 if m == 0 else 2))
        total += value * norm * radial * angular(m, x, y)
    return total


@functools.cache
def forbes(order, count):
    """Q_0 to Q_(count - 1) of an order m, each by its powers of u^2 and its mean square gradient.

    All of it is exact: the polynomials are not normalised yet.
    """
    # The term k is u^start + 2k; for m = 0 less the same with two powers more.
    start = order if order else 2

    def mean(power):
        """Mean of u^power with the weight 1/sqrt(1 - u^2): (power - 1)!! / power!!."""
        return math.prod((Fraction(k - 1, k) for k in range(2, power + 1, 2)), start=Fraction(1))

    def power_product(a, b):
        """Mean of the product of the gradients of u^a cos(m theta) and u^b cos(m theta)."""
        both = 1 if order == 0 else Fraction(1, 2)
        return both * (a * b + order**2) * mean(a + b - 2)

    def term(k):
        return [(start + 2 * k, 1)] + ([(start + 2 * k + 2, -1)] if order == 0 else [])

    gram = [[sum(f * g * power_product(a, b) for a, f in term(i) for b, g in term(j))
             for j in range(count)] for i in range(count)]

    def product(one, other):
        return sum(a * b * gram[i][j] for i, a in enumerate(one) for j, b in enumerate(other))

    found = []
    for n in range(count):
        q = [Fraction(0)] * n + [Fraction(1)]
        for other, square in found:
            along = product(q, other) / square
            other = other + [Fraction(0)] * (n + 1 - len(other))
            q = [a - along * b for a, b in zip(q, other)]
        found.append((q, product(q, q)))
    return found


def q(n, order, x):
    powers, square = forbes(order, n + 1)[n]
    powers = [mpf(a.numerator) / a.denominator for a in powers]
    norm = sqrt(mpf(square.numerator) / square.denominator)
    return mpmath.polyval(powers[::-1], x) * mpmath.sign(powers[0]) / norm


def on_sphere(p, x, y, departure):
    if "radius" not in p:
        return departure
    square = x * x + y * y
    return conicoid(square, p["radius"], 0) + departure / sqrt(1 - square / p["radius"] ** 2)


def forbes_qbfs(p, x, y):
    u = (x * x + y * y) / p["normalization_radius"] ** 2
    departure = u * (1 - u) * sum(a * q(n, 0, u) for (n,), a in coefficients(p))
    return on_sphere(p, x, y, departure)


def forbes_qcon(p, x, y):
    u = (x * x + y * y) / p["normalization_radius"] ** 2
    base = conicoid(x * x + y * y, p.get("radius"), p.get("conic", mpf(0)))
    return base + u**2 * sum(a * mpmath.jacobi(n, 0, 4, 2 * u - 1) for (n,), a in coefficients(p))


def forbes_q2d(p, x, y):
    r = p["normalization_radius"]
    u = (x * x + y * y) / r**2
    departure = mpf(0)
    for (n, m), a in coefficients(p):
        front = angular(m, x / r, y / r) if m else u * (1 - u)
        departure += a * front * q(n, abs(m), u)
    return on_sphere(p, x, y, departure)


def chebyshev(p, x, y):
    u, v = x / p["normalization_x"], y / p.get("normalization_y", p["normalization_x"])
    return sum(c * mpmath.chebyt(i, u) * mpmath.chebyt(j, v) for (i, j), c in coefficients(p))


def exact(value):
    """A parameter with its doubles made exact."""
    if isinstance(value, dict):
        return {key: exact(v) for key, v in value.items()}
    return value if isinstance(value, str) else mpf(value)


def expand(formula, params, x, y, digits):
    """The series of z, zx, zy along the curve, at a working precision."""
    with mpmath.workdps(digits):
        p = exact(params)

        def along(t, dx, dy):
            return formula(p, mpmath.polyval(x[::-1], t) + dx, mpmath.polyval(y[::-1], t) + dy)

        def series(order_x, order_y):
            return [
                mpmath.diff(along, (0, 0, 0), (k, order_x, order_y)) / factorial(k)
                for k in range(ORDER + 1)
            ]

        return [series(0, 0), series(1, 0), series(0, 1)]


def doubles(series):
    """As doubles; what vanishes to the agreed digits is zero."""
    return [float(c) if abs(c) > AGREED else 0.0 for c in series]


def cases():
    for model, params, aperture in MODELS:
        formula = globals()[model.replace("-", "_")]
        # The odd powers of the radius have no derivatives at the axis.
        for place_x, place_y in PLACES[1:] if model == "odd-asphere" else PLACES:
            for shape_x, shape_y in SHAPES:
                x = [aperture * place_x, *(STRIDE * aperture * c for c in shape_x)]
                y = [aperture * place_y, *(STRIDE * aperture * c for c in shape_y)]
                rough, fine = (
                    expand(formula, params, [mpf(c) for c in x], [mpf(c) for c in y], digits)
                    for digits in DIGITS
                )
                for a, b in zip(sum(rough, []), sum(fine, [])):
                    assert abs(a - b) <= AGREED * max(1, abs(b)), (model, params, x, y)
                z, zx, zy = (doubles(series) for series in fine)
                print(model, place_x, file=sys.stderr)
                yield {"surface": model, "params": params, "x": x, "y": y,
                       "z": z, "zx": zx, "zy": zy}


if __name__ == "__main__":
    made = {"script": "tests/reference/surfaces/series.py",
            "packages": f"mpmath {mpmath.__version__}"}
    lines = ",\n".join(json.dumps(case) for case in cases())
    print(f'{{"made_by": {json.dumps(made)}, "cases": [\n{lines}\n]}}')
