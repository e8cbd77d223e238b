"""Reference surfaces for playback.py: textbook formulas, and the recipe's quantities they need.

Each model takes the recipe's [surface] table and returns z(x, y) in mm for real or complex
arrays, so that slopes can be had by a complex step. Shares no code with turnpath.
"""

import math
import re

import numpy as np

LENGTH_MM = {"nm": 1e-6, "um": 1e-3, "µm": 1e-3, "μm": 1e-3, "mm": 1.0, "cm": 10.0, "m": 1e3,
             "in": 25.4}
ANGLE_RAD = {"deg": math.pi / 180, "°": math.pi / 180, "rad": 1.0, "mrad": 1e-3,
             "arcmin": math.pi / 10_800, "arcsec": math.pi / 648_000}
PER_LENGTH = {prefix + unit: 1 / mm for unit, mm in LENGTH_MM.items() for prefix in ("/", "1/")}
REQUIRED = object()


def quantity(table, key, units, default=REQUIRED):
    """The value of `key`, such as "0.08 /mm", in mm, rad or 1/mm; `default` where it is missing."""
    if key not in table and default is not REQUIRED:
        return default
    if key not in table:
        raise SystemExit(f"the recipe lacks `{key}`")
    match = re.fullmatch(r"\s*([-+]?[\d.]+(?:[eE][-+]?\d+)?)\s*(\S+)\s*", str(table[key]))
    if not match or match[2] not in units:
        raise SystemExit(f"`{key} = {table[key]!r}`: expected a number and one of {list(units)}")
    return float(match[1]) * units[match[2]]


def astigmatic(table):
    """z = k rho^2 sin 2theta = 2 k x y."""
    k = quantity(table, "k", PER_LENGTH)
    return lambda x, y: 2 * k * x * y


def conic(table):
    """Conic of revolution; positive radius: concave."""
    curvature = 1 / quantity(table, "radius", LENGTH_MM)
    constant = float(table.get("conic", 0.0))

    def sag(x, y):
        q = x * x + y * y
        return curvature * q / (1 + np.sqrt(1 - (1 + constant) * curvature**2 * q))

    return sag


def xy_polynomial(table):
    """Sum of c x^i y^j, c in mm^(1-i-j)."""
    terms = tuple((int(i), int(j), float(c)) for i, j, c in table["terms"])

    def sag(x, y):
        z = 0 * x
        for i, j, c in terms:
            z = z + c * x**i * y**j
        return z

    return sag


def toric(table):
    """z = R - sqrt((R - a + sqrt(a^2 - y^2))^2 - x^2): base arc a, turned at radius R.

    Each root has the sign of its radius; a negative radius is convex.
    """
    rotation = quantity(table, "radius_rotation", LENGTH_MM)
    base = quantity(table, "radius_base", LENGTH_MM)

    def sag(x, y):
        arc = rotation - base + math.copysign(1, base) * np.sqrt(base**2 - y * y)
        return rotation - math.copysign(1, rotation) * np.sqrt(arc * arc - x * x)

    return sag


def sinusoidal_array(table):
    """sum: A_x cos(2 pi f_x x) + A_y cos(2 pi f_y y); product: A sin(2 pi f_x x) sin(2 pi f_y y).

    The product has one amplitude: A = amplitude_x, and amplitude_y must not differ from it.
    """
    amplitude_x = quantity(table, "amplitude_x", LENGTH_MM)
    amplitude_y = quantity(table, "amplitude_y", LENGTH_MM, amplitude_x)
    frequency_x = quantity(table, "frequency_x", PER_LENGTH)
    k_x = 2 * math.pi * frequency_x
    k_y = 2 * math.pi * quantity(table, "frequency_y", PER_LENGTH, frequency_x)
    if table.get("form", "sum") == "sum":
        return lambda x, y: amplitude_x * np.cos(k_x * x) + amplitude_y * np.cos(k_y * y)
    if table["form"] != "product" or amplitude_x != amplitude_y:
        raise SystemExit("sinusoidal-array: form is sum or product, the latter of one amplitude")
    return lambda x, y: amplitude_x * np.sin(k_x * x) * np.sin(k_y * y)


def off_axis_paraboloid(table):
    """The parent z = r^2 / 2R_v, seen from the tangent frame of its point at r = x0.

    Local x points away from the parent's axis. A local point (x, y, z) has the parent's
    coordinates (x0 + c x - s z, y, x0^2/2R_v + s x + c z); Newton puts it on the parent.
    """
    vertex_radius = quantity(table, "vertex_radius", LENGTH_MM)
    offset = quantity(table, "off_axis_distance", LENGTH_MM)
    tilt = math.atan2(offset, vertex_radius)
    c, s = math.cos(tilt), math.sin(tilt)
    height = offset**2 / (2 * vertex_radius)

    def sag(x, y):
        z = 0 * (x + y)
        for _ in range(5):
            u = offset + c * x - s * z
            miss = height + s * x + c * z - (u * u + y * y) / (2 * vertex_radius)
            z = z - miss / (c + s * u / vertex_radius)
        return z

    return sag


def as_it_is(f):
    """f without being compiled."""
    return f


def placed(table, made=as_it_is):
    """scale * f(R(-clocking)(r - decentre)) + piston, of one [[surface]]."""
    if table["use"] not in SURFACES:
        raise SystemExit(f"no reference for the surface `{table['use']}`")
    f = made(SURFACES[table["use"]](table))
    scale = float(table.get("scale", 1.0))
    x0 = quantity(table, "decentre_x", LENGTH_MM, 0.0)
    y0 = quantity(table, "decentre_y", LENGTH_MM, 0.0)
    clocking = quantity(table, "clocking", ANGLE_RAD, 0.0)
    piston = quantity(table, "piston", LENGTH_MM, 0.0)
    c, s = math.cos(clocking), math.sin(clocking)

    def sag(x, y):
        u, v = x - x0, y - y0
        return scale * f(c * u + s * v, c * v - s * u) + piston

    return made(sag)


def turn(axis, angle):
    """The matrix of a right-handed rotation about axis 0, 1 or 2."""
    c, s = math.cos(angle), math.sin(angle)
    i, j = (axis + 1) % 3, (axis + 2) % 3
    matrix = np.eye(3)
    matrix[i, i], matrix[i, j], matrix[j, i], matrix[j, j] = c, -s, s, c
    return matrix


def posed(f, pose, made=as_it_is):
    """f in the frame of a part whose middle lies on f at (x, y): level, or tilted.

    The rotation is three plain ones. The point of f above (x, y) is looked for along the line with
    a difference quotient for the slope, which is Newton's to six digits, of complex numbers too.
    """
    x0 = quantity(pose, "x", LENGTH_MM, 0.0)
    y0 = quantity(pose, "y", LENGTH_MM, 0.0)
    if pose.get("level", False):
        p, q = np.imag(f(x0 + 1e-30j, y0)) / 1e-30, np.imag(f(x0, y0 + 1e-30j)) / 1e-30
        ascent = math.atan2(q, p)
        matrix = turn(2, ascent) @ turn(1, math.atan(math.hypot(p, q))) @ turn(2, -ascent)
    else:
        matrix = turn(1, quantity(pose, "tilt_y", ANGLE_RAD, 0.0))
        matrix = matrix @ turn(0, quantity(pose, "tilt_x", ANGLE_RAD, 0.0))
    z0 = f(x0, y0)

    def turned(x, y, z, k):
        return matrix[0, k] * x + matrix[1, k] * y + matrix[2, k] * z

    turned = made(turned)

    def miss(x, y, z):
        return z0 + turned(x, y, z, 2) - f(x0 + turned(x, y, z, 0), y0 + turned(x, y, z, 1))

    miss = made(miss)

    def sag(x, y):
        z = 0 * (x + y)
        for _ in range(4):
            here = miss(x, y, z)
            z = z - here * 1e-6 / (miss(x, y, z + 1e-6) - here)
        return z

    return made(sag)


def added(f, g):
    """f + g."""
    return lambda x, y: f(x, y) + g(x, y)


def surface(recipe, made=as_it_is):
    """The sag of a recipe: one surface or the sum of several, in the pose of the part. `made` makes a
    function of each formula: it may compile it."""
    tables = recipe["surface"]
    entries = [placed(table, made) for table in (tables if isinstance(tables, list) else [tables])]
    total = entries[0]
    for entry in entries[1:]:
        total = made(added(total, entry))
    pose = recipe["part"].get("pose")
    return total if pose is None else posed(total, pose, made)


SURFACES = {"astigmatic": astigmatic, "conic": conic, "xy-polynomial": xy_polynomial,
            "toric": toric, "sinusoidal-array": sinusoidal_array,
            "off-axis-paraboloid": off_axis_paraboloid}
