"""Writes poses.json: sums of surfaces in the frame of a part that lies on them, by mpmath.

A sum is a conicoid plus waves that are scaled, moved, turned and lifted. Its points are turned by
rotation matrices about the part's middle, and the point that comes to lie above (x, y) is found by
Newton's iteration on its two coordinates on the sum: the program instead goes along one line to
the sum. Derivatives are numerical, of 60 digits or more.

A case: z(t), zx(t), zy(t) along the curve x(t), y(t), all as Taylor coefficients 0 to 4. The inputs
are exact doubles; their first coefficients are also points for value and gradient.

Run: python poses.py > poses.json
"""

import json

import mpmath
from mpmath import cos, matrix, mpf, sin, sqrt

ORDER = 4

PLACEMENTS = {
    "plain": dict(scale=1.0, decentre=(0.0, 0.0), clocking=0.0, piston=0.0),
    "moved": dict(scale=-0.5, decentre=(1.25, -0.75), clocking=0.6875, piston=0.25),
}
SUMS = {
    # A bowl with shallow waves, and a hyperboloid with steep ones.
    "bowl": dict(curvature=0.015625, conic=0.0, height=0.03125, wave=0.5, placement="moved"),
    "hyperboloid": dict(curvature=-0.0078125, conic=-1.5, height=0.0625, wave=0.875,
                        placement="plain"),
}
POSES = [
    dict(x=12.5, y=-7.0, level=True),
    dict(x=-3.0, y=4.5, tilt_x=0.21875, tilt_y=-0.34375),
    dict(x=5.0, y=2.0, tilt_x=0.0, tilt_y=0.0),
]
CURVES = [
    ([0.0, 0.75, -0.25, 0.125, 0.0625], [0.0, -0.5, 0.375, -0.0625, 0.03125]),
    ([3.5, -0.3125, 0.5, 0.1875, -0.25], [-2.25, 0.875, 0.125, -0.375, 0.09375]),
    ([-6.0, 0.5, 0.25, 0.0, 0.125], [4.75, 1.0, -0.25, 0.5, 0.0]),
]


def sag(s, x, y):
    square = x * x + y * y
    c = mpf(s["curvature"])
    conicoid = c * square / (1 + sqrt(1 - (1 + mpf(s["conic"])) * c * c * square))
    place = PLACEMENTS[s["placement"]]
    turn = mpf(place["clocking"])
    u, v = x - mpf(place["decentre"][0]), y - mpf(place["decentre"][1])
    u, v = cos(turn) * u + sin(turn) * v, cos(turn) * v - sin(turn) * u
    wave = mpf(s["wave"])
    tenth = [mpf(n) for n in (0.3, 1.3, 0.2)]
    # The program's factor is the product of two doubles.
    faster = mpf(1.3 * s["wave"])
    waves = mpf(s["height"]) * (sin(wave * u + tenth[0]) + cos(faster * v - tenth[2] * u))
    return conicoid + mpf(place["scale"]) * waves + mpf(place["piston"])


def slopes(s, x, y):
    return (mpmath.diff(lambda a: sag(s, a, y), x), mpmath.diff(lambda a: sag(s, x, a), y))


def about_x(angle):
    return matrix([[1, 0, 0], [0, cos(angle), -sin(angle)], [0, sin(angle), cos(angle)]])


def about_y(angle):
    return matrix([[cos(angle), 0, sin(angle)], [0, 1, 0], [-sin(angle), 0, cos(angle)]])


def about_z(angle):
    return matrix([[cos(angle), -sin(angle), 0], [sin(angle), cos(angle), 0], [0, 0, 1]])


def rotation(s, pose):
    if "level" not in pose:
        return about_y(mpf(pose["tilt_y"])) * about_x(mpf(pose["tilt_x"]))
    # Steepest ascent to the x axis, down by the steepest angle, and back.
    p, q = slopes(s, mpf(pose["x"]), mpf(pose["y"]))
    turn, steep = mpmath.atan2(q, p), mpmath.atan(sqrt(p * p + q * q))
    return about_z(turn) * about_y(steep) * about_z(-turn)


def posed(s, pose, turned, x, y):
    """Height and slopes of the posed sum above (x, y)."""
    x0, y0 = mpf(pose["x"]), mpf(pose["y"])
    z0 = sag(s, x0, y0)

    def to_part(u, v):
        return turned * matrix([u - x0, v - y0, sag(s, u, v) - z0])

    start = turned.T * matrix([x, y, 0])
    u, v = x0 + start[0], y0 + start[1]
    for _ in range(200):
        at = to_part(u, v)
        p, q = slopes(s, u, v)
        along_u, along_v = turned * matrix([1, 0, p]), turned * matrix([0, 1, q])
        jacobian = matrix([[along_u[0], along_v[0]], [along_u[1], along_v[1]]])
        step = mpmath.lu_solve(jacobian, matrix([x - at[0], y - at[1]]))
        u, v = u + step[0], v + step[1]
        if mpmath.norm(step) < mpf(10) ** (-mpmath.mp.dps // 2 - 10):
            break
    else:
        raise ArithmeticError("no root")
    at = to_part(u, v)
    p, q = slopes(s, u, v)
    normal = turned * matrix([-p, -q, 1])
    return at[2], -normal[0] / normal[2], -normal[1] / normal[2]


def expansion(function):
    """Coefficients 0 to 4 of a function of t, by interpolation near 0 at 140 digits."""
    with mpmath.workdps(140):
        h = mpf(10) ** -12
        nodes = [h * k for k in range(-4, 5)]
        rows = matrix([[node**k for k in range(len(nodes))] for node in nodes])
        values = [function(node) for node in nodes]
        solved = [mpmath.lu_solve(rows, matrix([value[i] for value in values])) for i in range(3)]
        return [[float(one[k]) for k in range(ORDER + 1)] for one in solved]


def cases():
    for name, s in SUMS.items():
        for pose in POSES:
            with mpmath.workdps(140):
                turned = rotation(s, pose)
            for x, y in CURVES:
                def at(t, x=x, y=y):
                    here = [mpmath.polyval([mpf(c) for c in reversed(line)], t) for line in (x, y)]
                    return posed(s, pose, turned, *here)

                z, zx, zy = expansion(at)
                place = PLACEMENTS[s["placement"]]
                yield {"name": name, "sum": s, "placement": place, "pose": pose,
                       "x": x, "y": y, "z": z, "zx": zx, "zy": zy}


if __name__ == "__main__":
    lines = ",\n".join(json.dumps(case) for case in cases())
    made = {"script": "tests/reference/poses.py", "packages": f"mpmath {mpmath.__version__}"}
    print(f'{{"made_by": {json.dumps(made)}, "cases": [\n{lines}\n]}}')
