"""Writes surfaces.json: every surface, its slopes and their order-4 series, by mpmath.

Each surface is its textbook formula, not the rearranged one of the program; the off-axis
paraboloid is its parent, turned, and met by Newton's iteration. Derivatives are mpmath's
numerical ones, made twice, at 150 and 200 digits, which must agree to 50.

A case: z(t), zx(t), zy(t) along the curve x(t), y(t), all as Taylor coefficients 0 to 4. The
inputs are exact doubles; their first coefficients are also points for value and gradient.

Run: python surfaces.py > surfaces.json
"""

import json

import mpmath
from mpmath import cos, mpf, pi, sin, sqrt

ORDER = 4
DIGITS = (150, 200)
AGREED = mpf(10) ** -50

# Shapes of the curves: coefficients 1 to 4 of x(t) and y(t), times the stride of the surface.
SHAPES = [
    ([0.75, -0.25, 0.125, 0.0625], [-0.5, 0.375, -0.0625, 0.03125]),
    ([-0.3125, 0.5, 0.1875, -0.25], [0.875, 0.125, -0.375, 0.09375]),
]
# Places, in units of the size of the surface.
PLACES = [
    (0.0, 0.0), (0.37109375, -0.69140625), (-0.8203125, 0.22265625), (0.53515625, 0.97265625),
    (-0.28515625, -0.44140625),
]


def astigmatic(p, x, y):
    """k rho^2 sin 2 theta."""
    rho_squared = x * x + y * y
    if rho_squared == 0:
        return mpf(0)
    return p["k"] * rho_squared * (2 * x * y / rho_squared)


def conic(p, x, y):
    c, rho_squared = 1 / p["radius"], x * x + y * y
    return c * rho_squared / (1 + sqrt(1 - (1 + p["conic"]) * c * c * rho_squared))


def xy_polynomial(p, x, y):
    return sum(c * x ** int(i) * y ** int(j) for i, j, c in p["terms"])


def toric(p, x, y):
    """R - sqrt((R - a + sqrt(a^2 - y^2))^2 - x^2); a negative radius takes the other root."""
    big, small = p["radius_rotation"], p["radius_base"]
    arc = big - small + mpmath.sign(small) * sqrt(small * small - y * y)
    return big - mpmath.sign(big) * sqrt(arc * arc - x * x)


def sinusoidal_array(p, x, y):
    amplitude_y = p.get("amplitude_y", p["amplitude_x"])
    frequency_y = p.get("frequency_y", p["frequency_x"])
    u, v = 2 * pi * p["frequency_x"] * x, 2 * pi * frequency_y * y
    if p["form"] == "product":
        return p["amplitude_x"] * sin(u) * sin(v)
    return p["amplitude_x"] * cos(u) + amplitude_y * cos(v)


def off_axis_paraboloid(p, x, y):
    """The point of the parent Z = (X^2 + Y^2)/(2 R_v) on the segment's normal above (x, y)."""
    radius, distance = p["vertex_radius"], p["off_axis_distance"]
    c = 1 / sqrt(1 + (distance / radius) ** 2)
    s = c * distance / radius
    height = distance**2 / (2 * radius)
    z = mpf(0)
    for _ in range(60):
        across, up = distance + c * x - s * z, height + s * x + c * z
        miss = up - (across**2 + y * y) / (2 * radius)
        step = miss / (c + s * across / radius)
        z -= step
        if abs(step) <= mpf(10) ** (4 - mpmath.mp.dps):
            return z
    raise ArithmeticError("Newton's iteration does not settle")


# Name, formula, size and stride in mm, parameters.
SURFACES = [
    ("astigmatic", astigmatic, 2.5, 2.5, {"k": 0.08}),
    ("astigmatic", astigmatic, 25.0, 25.0, {"k": -3.84e-6}),
    ("conic", conic, 5.0, 5.0, {"radius": 12.5, "conic": 0.0}),
    ("conic", conic, 10.0, 10.0, {"radius": -40.0, "conic": -1.3}),
    ("conic", conic, 3.0, 3.0, {"radius": 8.0, "conic": 0.7}),
    ("conic", conic, 100.0, 100.0, {"radius": 915.0, "conic": -1.0}),
    ("xy-polynomial", xy_polynomial, 4.0, 4.0, {"terms": [
        [0, 0, 0.01], [1, 0, -0.002], [2, 0, 0.013], [1, 1, -0.02], [0, 2, 0.031],
        [3, 1, 1e-4], [0, 5, -3e-6], [6, 2, 1e-7]]}),
    ("xy-polynomial", xy_polynomial, 4.0, 4.0, {"terms": [[3, 0, 0.002], [0, 4, -0.001]]}),
    ("toric", toric, 10.0, 10.0, {"radius_rotation": 40.0, "radius_base": 25.0}),
    ("toric", toric, 10.0, 10.0, {"radius_rotation": -40.0, "radius_base": 25.0}),
    ("toric", toric, 10.0, 10.0, {"radius_rotation": 30.0, "radius_base": -55.0}),
    ("toric", toric, 10.0, 10.0, {"radius_rotation": -33.0, "radius_base": -21.0}),
    ("sinusoidal-array", sinusoidal_array, 5.0, 0.5, {
        "amplitude_x": 0.005, "amplitude_y": 0.005, "frequency_x": 0.4, "frequency_y": 0.4,
        "form": "sum"}),
    ("sinusoidal-array", sinusoidal_array, 5.0, 0.5, {
        "amplitude_x": 0.01, "amplitude_y": 0.004, "frequency_x": 0.7, "frequency_y": -0.3,
        "form": "sum"}),
    ("sinusoidal-array", sinusoidal_array, 10.0, 0.25, {
        "amplitude_x": 0.05, "frequency_x": 1.0, "form": "product"}),
    ("off-axis-paraboloid", off_axis_paraboloid, 106.5, 106.5, {
        "vertex_radius": 915.0, "off_axis_distance": 915.0}),
    ("off-axis-paraboloid", off_axis_paraboloid, 20.0, 20.0, {
        "vertex_radius": -120.0, "off_axis_distance": 45.0}),
    ("off-axis-paraboloid", off_axis_paraboloid, 20.0, 20.0, {
        "vertex_radius": 200.0, "off_axis_distance": -80.0}),
    ("off-axis-paraboloid", off_axis_paraboloid, 20.0, 20.0, {
        "vertex_radius": 75.0, "off_axis_distance": 0.0}),
]


def exact(value):
    """A parameter with its doubles made exact."""
    if isinstance(value, list):
        return [exact(v) for v in value]
    return value if isinstance(value, str) else mpf(value)


def expand(formula, params, x, y, digits):
    """The series of z, zx, zy along the curve, at a working precision."""
    with mpmath.workdps(digits):
        p = {name: exact(value) for name, value in params.items()}

        def along(t, dx, dy):
            return formula(p, mpmath.polyval(x[::-1], t) + dx, mpmath.polyval(y[::-1], t) + dy)

        def series(order_x, order_y):
            return [
                mpmath.diff(along, (0, 0, 0), (k, order_x, order_y)) / mpmath.factorial(k)
                for k in range(ORDER + 1)
            ]

        return [series(0, 0), series(1, 0), series(0, 1)]


def doubles(series):
    """As doubles; what vanishes to the agreed digits is zero."""
    return [float(c) if abs(c) > AGREED else 0.0 for c in series]


def cases():
    for name, formula, size, stride, params in SURFACES:
        for place_x, place_y in PLACES:
            for shape_x, shape_y in SHAPES:
                x = [size * place_x, *(stride * c for c in shape_x)]
                y = [size * place_y, *(stride * c for c in shape_y)]
                rough, fine = (
                    expand(formula, params, [mpf(c) for c in x], [mpf(c) for c in y], digits)
                    for digits in DIGITS
                )
                for a, b in zip(sum(rough, []), sum(fine, [])):
                    assert abs(a - b) <= AGREED * max(1, abs(b)), (name, params, x, y)
                z, zx, zy = (doubles(series) for series in fine)
                yield {"surface": name, "params": params, "x": x, "y": y,
                       "z": z, "zx": zx, "zy": zy}


print("[\n" + ",\n".join(json.dumps(case) for case in cases()) + "\n]")
