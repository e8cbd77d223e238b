"""On AST-50 a traced surface takes at most 1.3 times of native, an untraced sampler at most 3 times.

The whole run counts: law, blocks, measurement. What counts is the processor's time on one thread, the
least of three runs in turns: another program on the machine can only make a run slower.
"""

import time
from pathlib import Path

import numpy as np

import turnpath

AST_50 = Path(__file__).parents[3] / "docs" / "recipes" / "astigmatic-50mm.toml"
CHANGES = {"output.posts": [], "output.data": []}


@turnpath.surface
def saddle(x, y, k: turnpath.PerLength):
    """z = 2 k x y, which is k ρ² sin 2θ."""
    return 2 * k * x * y


@turnpath.sampler
def even(path, block, step: turnpath.Angle = "6 deg"):
    """Control points at even steps of C, as the sampler equal-angle has them. It asks the path at each
    of them, as a sampler that looks at the path must."""
    count = np.ceil(2 * np.pi / step - 1e-9)
    turns = [turnpath.subdivide(start, end, count) for start, end in block.turns()]
    nodes = np.concatenate(turns)
    x, z = path.series_at(nodes)
    return nodes[np.isfinite(x[:, 4]) & np.isfinite(z[:, 4])]


def fastest(changes):
    """The least processor time of three runs of each, s, and the last result of each."""
    times = {name: [] for name in changes}
    results = {}
    for _ in range(3):
        for name, change in changes.items():
            begun = time.process_time()
            results[name] = turnpath.run(
                AST_50, {**CHANGES, **change}, strategies=[saddle, even], threads=1
            )
            times[name].append(time.process_time() - begun)
    return {name: min(all) for name, all in times.items()}, results


def test_a_traced_surface_is_as_fast_as_native(capsys):
    times, results = fastest(
        {"native": {}, "traced": {"surface": {"use": "saddle", "k": "3.84e-6 /mm"}}}
    )
    ratio = times["traced"] / times["native"]
    with capsys.disabled():
        print(f"\nAST-50: native {times['native']:.3f} s, traced {times['traced']:.3f} s: {ratio:.2f}")
    one, other = (results[name].toolpath for name in ("native", "traced"))
    assert len(one.t) == len(other.t) and np.abs(one.z - other.z).max() < 1e-12
    assert ratio < 1.3


def test_an_untraced_sampler_takes_at_most_three_times(capsys):
    times, results = fastest(
        {
            "native": {"sampler": {"use": "equal-angle", "step": "6 deg"}},
            "python": {"sampler": {"use": "even", "step": "6 deg"}},
        }
    )
    ratio = times["python"] / times["native"]
    with capsys.disabled():
        print(f"\nAST-50: native {times['native']:.3f} s, python {times['python']:.3f} s: {ratio:.2f}")
    for one, other in zip(results["native"].toolpath, results["python"].toolpath):
        assert np.abs(one - other).max() <= 1e-9 * np.abs(other).max()
    assert ratio < 3
