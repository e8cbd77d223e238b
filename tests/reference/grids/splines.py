"""Tensor splines of degree 5, for tests/reference/grids/splines.json.

Heights on a regular grid, and at some places what the spline through them has:

- heights and slopes by scipy 1.17.1, `make_interp_spline(k=5)` along both axes ("not a knot");
- series of height and slopes along curves, to 50 digits by mpmath: collocation and de Boor's
  recurrence on scipy's knots, differentiated by mpmath.

The first are held against the second here.

    python splines.py > splines.json        # needs numpy, scipy and mpmath
"""

import json
from importlib.metadata import version

import numpy as np
from mpmath import lu_solve, matrix, mp, mpf, taylor
from scipy.interpolate import make_interp_spline

mp.dps = 50
DEGREE = 5


def scipy_spline(x, y, heights):
    """Heights have rows along y."""
    along_x = make_interp_spline(x, heights.T, k=DEGREE)
    both = make_interp_spline(y, along_x.c.T, k=DEGREE)

    def at(place, nu):
        of_y = both(place[1], nu=nu[1])
        line = make_interp_spline(x, heights[0], k=DEGREE)
        line.c = of_y
        return float(line(place[0], nu=nu[0]))

    return at, along_x.t


def exact_knots(points):
    inner = points[3:-3]
    return [points[0]] * 6 + list(inner) + [points[-1]] * 6


def basis(knots, count, cell, u):
    """All splines on the polynomial piece over a cell, by de Boor's recurrence."""
    lines = [mpf(1) if i == cell else mpf(0) for i in range(count + DEGREE)]
    for k in range(1, DEGREE + 1):
        after = []
        for i in range(count + DEGREE - k):
            left, right = knots[i + k] - knots[i], knots[i + k + 1] - knots[i + 1]
            value = mpf(0)
            if left:
                value += (u - knots[i]) / left * lines[i]
            if right:
                value += (knots[i + k + 1] - u) / right * lines[i + 1]
            after.append(value)
        lines = after
    return lines[:count]


def cell_of(knots, count, u):
    cell = DEGREE
    while cell < count - 1 and knots[cell + 1] <= u:
        cell += 1
    return cell


def collocation(points):
    knots, count = exact_knots(points), len(points)
    rows = [basis(knots, count, cell_of(knots, count, u), u) for u in points]
    return knots, matrix(rows)


def exact_spline(x, y, heights):
    x, y = [mpf(v) for v in x], [mpf(v) for v in y]
    knots_x, of_x = collocation(x)
    knots_y, of_y = collocation(y)
    values = matrix([[mpf(float(h)) for h in row] for row in heights])
    # Rows along y: solve along y for each column, then along x for each row.
    half = [lu_solve(of_y, values[:, j]) for j in range(len(x))]
    rows = [lu_solve(of_x, matrix([half[j][i] for j in range(len(x))])) for i in range(len(y))]

    def on_piece(place):
        cells = [cell_of(knots_x, len(x), place[0]), cell_of(knots_y, len(y), place[1])]

        def at(u, v):
            bx, by = basis(knots_x, len(x), cells[0], u), basis(knots_y, len(y), cells[1], v)
            total = mpf(0)
            for i, b in enumerate(by):
                if b:
                    total += b * sum(rows[i][j] * a for j, a in enumerate(bx) if a)
            return total

        return at

    return on_piece


def curve(coefficients):
    return lambda t: sum(mpf(c) * t**k for k, c in enumerate(coefficients))


def series(function):
    with mp.workdps(120):
        return [float(c) for c in taylor(function, 0, 4)]


def slope(at, u, v, axis):
    """The exact slope of a polynomial piece, from its own Taylor series."""
    if axis == 0:
        return taylor(lambda s: at(u + s, v), 0, 1)[1]
    return taylor(lambda s: at(u, v + s), 0, 1)[1]


def case(chance, columns, rows, pitch, first, places, noise=2e-3):
    x = first[0] + pitch[0] * np.arange(columns)
    y = first[1] + pitch[1] * np.arange(rows)
    heights = 0.05 * np.sin(1.3 * x[None, :]) * np.cos(0.9 * y[:, None]) + 0.01 * x[None, :] * y[:, None]
    if noise:
        heights += chance.normal(0, noise, heights.shape)
    scipy_at, _ = scipy_spline(x, y, heights)
    exact = exact_spline(x, y, heights) if columns * rows < 200 else None
    result = {
        "columns": columns,
        "rows": rows,
        "pitch": list(pitch),
        "first": list(first),
        "noise": noise,
        "heights": heights.tolist(),
        "places": [],
        "curves": [],
    }
    inside = lambda size: (chance.uniform(0, size[0] - 1), chance.uniform(0, size[1] - 1))
    for k in range(places):
        u, v = inside((columns, rows))
        if k == 0:
            u, v = 0.0, rows - 1.0  # a corner
        place = (first[0] + pitch[0] * u, first[1] + pitch[1] * v)
        found = [scipy_at(place, nu) for nu in [(0, 0), (1, 0), (0, 1)]]
        if exact:
            at = exact(place)
            u, v = mpf(place[0]), mpf(place[1])
            wanted = [at(u, v), slope(at, u, v, 0), slope(at, u, v, 1)]
            assert all(abs(a - b) < 1e-12 for a, b in zip(found, wanted)), (found, wanted)
        result["places"].append({"x": place[0], "y": place[1], "z_zx_zy": found})
    for _ in range(4 if exact else 0):
        u, v = inside((columns, rows))
        curves = [[first[0] + pitch[0] * u], [first[1] + pitch[1] * v]]
        for one in curves:
            one += [float(c) for c in chance.uniform(-1, 1, 4)]
        at = exact((curves[0][0], curves[1][0]))
        along = [curve(one) for one in curves]
        result["curves"].append(
            {
                "x": curves[0],
                "y": curves[1],
                "z": series(lambda t: at(along[0](t), along[1](t))),
                "zx": series(lambda t: slope(at, along[0](t), along[1](t), 0)),
                "zy": series(lambda t: slope(at, along[0](t), along[1](t), 1)),
            }
        )
    return result


if __name__ == "__main__":
    chance = np.random.default_rng(14)
    cases = [
        case(chance, 6, 6, (0.5, 0.5), (-1.25, -1.25), 10),
        case(chance, 7, 9, (0.25, 0.4), (-1.0, 0.5), 10),
        case(chance, 13, 11, (0.5, 0.3), (-3.0, -1.5), 20),
        case(chance, 60, 45, (0.1, 0.1), (-3.0, -2.2), 60),
        # Without noise the whole surface is this spline, up to the edges.
        case(chance, 60, 45, (0.1, 0.1), (-3.0, -2.2), 60, noise=0),
    ]
    packages = ", ".join(f"{name} {version(name)}" for name in ["numpy", "scipy", "mpmath"])
    made = {"script": "tests/reference/grids/splines.py", "packages": packages}
    text = ",\n".join(json.dumps(one) for one in cases)
    print(f'{{"made_by": {json.dumps(made)}, "cases": [\n{text}\n]}}')
