"""Reference series of the compensated tool centre, to 50 digits, for tests/reference/compensators.json.

Each case is a surface, a compensator and a curve (theta(t), rho(t)); the answer holds the Taylor
coefficients of X(t) and Z(t) at t = 0 up to order 4. The centre is evaluated by its definition at
each t (for z-direction the foot is solved for anew) and differentiated numerically at a working
precision that mpmath raises until 50 digits hold: nothing is shared with the series arithmetic
under test.

    python compensators.py > compensators.json        # needs mpmath
"""

import json
import random

from mpmath import cos, findroot, mp, mpf, sin, sqrt, taylor

mp.dps = 50
NOSE_RADIUS = 1.0


def astigmatic(k):
    k = mpf(k)
    return lambda x, y: (2 * k * x * y, 2 * k * y, 2 * k * x)


def toric(rotation, base):
    """Concave for positive radii; negative ones give the same surface upside down."""
    sign = 1 if rotation > 0 else -1
    r, a = sign * mpf(rotation), sign * mpf(base)

    def surface(x, y):
        arc = sqrt(a**2 - y**2)
        v = r - a + arc
        root = sqrt(v**2 - x**2)
        return sign * (r - root), sign * x / root, sign * v * y / (arc * root)

    return surface


def along_ray(surface, theta, rho):
    """Height and slope of the radial section."""
    z, zx, zy = surface(rho * cos(theta), rho * sin(theta))
    return z, zx * cos(theta) + zy * sin(theta)


def normal(surface, theta, rho):
    z, slope = along_ray(surface, theta, rho)
    w = sqrt(1 + slope**2)
    return rho - NOSE_RADIUS * slope / w, z + NOSE_RADIUS / w


def z_direction(surface, theta, rho):
    def gap(d):
        slope = along_ray(surface, theta, rho + d)[1]
        return d - NOSE_RADIUS * slope / sqrt(1 + slope**2)

    start = -gap(mpf(0))
    d = findroot(gap, (start, start + mpf("1e-3")), maxsteps=100)
    return rho, along_ray(surface, theta, rho + d)[0] + sqrt(NOSE_RADIUS**2 - d**2)


def polynomial(coefficients, t):
    return sum(mpf(c) * t**i for i, c in enumerate(coefficients))


def centre_series(centre, surface, theta, rho):
    def part(which):
        f = lambda t: centre(surface, polynomial(theta, t), polynomial(rho, t))[which]
        return [float(c) for c in taylor(f, 0, 4)]

    return part(0), part(1)


def curves():
    """Spirals as they occur: fine feeds, a feed that follows the angle, and a general curve."""
    chance = random.Random(20)
    at = lambda: (chance.uniform(0, 6.28), chance.uniform(0.05, 2.5))
    for _ in range(6):
        theta, rho = at()
        yield [theta, 1, 0, 0, 0], [rho, chance.uniform(-0.005, 0.005), 0, 0, 0]
    for _ in range(4):
        theta, rho = at()
        yield [theta, 1, 0, 0, 0], [rho] + [chance.uniform(-s, s) for s in (0.5, 0.3, 0.2, 0.1)]
    for _ in range(2):
        theta, rho = at()
        yield [theta] + [chance.uniform(-1, 1) for _ in range(4)], [rho] + [
            chance.uniform(-1, 1) for _ in range(4)
        ]


SURFACES = [
    ("astigmatic", {"k": 0.08}, astigmatic(0.08)),
    ("toric", {"radius_rotation": 9.0, "radius_base": 5.0}, toric(9.0, 5.0)),
    ("toric", {"radius_rotation": -7.0, "radius_base": -11.0}, toric(-7.0, -11.0)),
]
COMPENSATORS = [("z-direction", z_direction), ("normal", normal)]


def cases():
    for surface_name, params, surface in SURFACES:
        for theta, rho in curves():
            for compensator, centre in COMPENSATORS:
                x, z = centre_series(centre, surface, theta, rho)
                yield {
                    "surface": surface_name,
                    "params": params,
                    "compensator": compensator,
                    "theta": [float(c) for c in theta],
                    "rho": [float(c) for c in rho],
                    "x": x,
                    "z": z,
                }


if __name__ == "__main__":
    print("[\n" + ",\n".join(json.dumps(case) for case in cases()) + "\n]")
