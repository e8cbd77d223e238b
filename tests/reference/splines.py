"""Reference slopes of cubic splines on uneven nodes, for tests/reference/splines.json.

From scipy.interpolate.CubicSpline, with each of its end conditions, on random nodes whose steps
differ by up to 1 : 1000; and from two to five nodes.

    python splines.py > splines.json        # needs numpy and scipy
"""

import json
from importlib.metadata import version

import numpy as np
from scipy.interpolate import CubicSpline

ENDS = ["clamped", "natural", "not-a-knot"]


def nodes(chance, count, spread):
    steps = 0.01 * spread ** chance.uniform(-0.5, 0.5, count - 1)
    return np.concatenate([[0.0], np.cumsum(steps)])


def axes(t):
    """Values and rates of something like C, X and Z."""
    return [
        (52.36 * t, np.full_like(t, 52.36)),
        (2.5 - 0.2 * t + 0.01 * np.sin(9 * t), -0.2 + 0.09 * np.cos(9 * t)),
        (0.4 * np.sin(104.7 * t + 0.3), 41.88 * np.cos(104.7 * t + 0.3)),
    ]


def slopes(t, values, rates, ends):
    if ends == "clamped":
        condition = ((1, rates[0]), (1, rates[-1]))
    elif len(t) == 2:  # a lone segment without given slopes is straight
        return [(values[1] - values[0]) / (t[1] - t[0])] * 2
    else:
        condition = ends
    return CubicSpline(t, values, bc_type=condition)(t, 1).tolist()


def cases():
    chance = np.random.default_rng(20)
    sizes = [(2, 1), (3, 1), (3, 10), (4, 10), (5, 1000), (60, 1), (60, 10), (200, 1000)]
    for count, spread in sizes:
        t = nodes(chance, count, spread)
        measured = axes(t)
        for ends in ENDS:
            yield {
                "ends": ends,
                "t": t.tolist(),
                "values": [v.tolist() for v, _ in measured],
                "end_rates": [[r[0], r[-1]] for _, r in measured],
                "slopes": [slopes(t, v, r, ends) for v, r in measured],
            }


if __name__ == "__main__":
    packages = ", ".join(f"{name} {version(name)}" for name in ["numpy", "scipy"])
    made = {"script": "tests/reference/splines.py", "packages": packages}
    lines = ",\n".join(json.dumps(case) for case in cases())
    print(f'{{"made_by": {json.dumps(made)}, "cases": [\n{lines}\n]}}')
