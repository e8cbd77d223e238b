#!/usr/bin/env python3
"""The largest spoke, and the largest spiral arms, on paths that turnpath makes, from their toolpath.csv.

    spokes.py TURNPATH

runs the program on each case below and keeps the figures in spokes.json beside this script. The path
is played, and its true height found, by playback.py, which shares no code with turnpath.

A window has 64 turns (or all of a path with fewer), and begins every 32 turns; the last one ends with
the path. At each of 1024 angles of a turn, a little behind the angle, the error (played minus true Z) is
averaged over the turns of the window whose contact lies on the part. The spoke is the largest 2|F_k| of
these means, 3 <= k <= 512, over all windows.

Arms turn by the same angle from turn to turn. On the turns of a window that lie on the part as a whole,
F_k of each turn is taken over the turns once more, at rates of 1/256 of a period a turn. The arms are the
largest 2|F| of these at rates from one period in the window to a quarter of a period a turn, either way.
"""

import json
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "playback"))

from playback import NM_PER_MM, Recipe, ToolPath, radians, true_z  # noqa: E402

RECIPES = HERE.parents[2] / "docs" / "recipes"
EXACT = ["velocity={ use = \"analytic\" }"]
CASES = {
    "conic, steps that do not wander": (HERE / "conic.toml", ["sampler.wander=false"]),
    "conic, steps that wander": (HERE / "conic.toml", []),
    "conic, steps of atpg": (HERE / "conic.toml", ["sampler={ use = \"atpg\" }"]),
    "astigmatic": (RECIPES / "astigmatic-5mm.toml", EXACT),
}
ANGLES, WINDOW, ADVANCE = 1024, 64, 32
LOWEST, HIGHEST = 3, 512
RATES, FEWEST_TURNS = 256, 4
BESIDE_DEG = 1e-7
SCAN = 33
TOLERANCE_EXCEEDED = 1  # turnpath's exit status when a path is made but holds no tolerance


def errors(recipe, path, turns):
    """Machined minus wanted at all angles of these turns, mm; NaN off the part."""
    c_deg = 360.0 * (turns[:, None] + np.arange(ANGLES) / ANGLES) + BESIDE_DEG
    played = (c_deg > path.nodes[0, 1]) & (c_deg < path.nodes[-1, 1])
    when = path.when(c_deg[played])
    x, theta = path.play("x", *when), radians(c_deg[played])
    error = path.play("z", *when) - true_z(recipe, theta, x, SCAN)
    foot = contact(recipe, theta, x)
    on_part = (foot >= recipe.hole_radius) & (foot <= recipe.part_radius)
    found = np.full(c_deg.shape, np.nan)
    found[played] = np.where(on_part, error, np.nan)
    return found


def contact(recipe, theta, x):
    """The radius of the contact: where the profile's normal leads to X."""
    if recipe.compensator == "none":
        return x
    profile, foot = recipe.profile(theta), x
    for _ in range(50):
        slope = np.imag(profile(foot + 1e-30j)) / 1e-30
        foot = x + recipe.nose_radius * slope / np.sqrt(1 + slope * slope)
    return foot


def windows(count):
    """The turns of each window, counted from the first of `count`."""
    last = max(count - WINDOW, 0)
    starts = sorted({*range(0, last + 1, ADVANCE), last})
    return [slice(start, start + WINDOW) for start in starts]


def arms(of_turns):
    """The largest arms on the turns of a window, mm: their amplitude, number, and turns from one to the next."""
    whole = ~np.any(np.isnan(of_turns), axis=1)
    if 2 * np.count_nonzero(whole) < len(whole):
        return (0.0, 0, 0.0)
    harmonics = np.fft.rfft(np.where(whole[:, None], of_turns, 0.0), axis=1)[:, :HIGHEST] / ANGLES
    # What stays is spokes, and would stand at all rates by the edges of the window.
    harmonics[whole] -= harmonics[whole].mean(axis=0)
    rates = np.fft.fft(harmonics, RATES, axis=0)
    slowest = -(-RATES // len(whole))
    kept = np.arange(slowest, RATES // FEWEST_TURNS + 1)
    if not len(kept):
        return (0.0, 0, 0.0)
    sizes = 2 * np.maximum(abs(rates[kept]), abs(rates[RATES - kept]))[:, LOWEST:] / np.count_nonzero(whole)
    rate, k = np.unravel_index(np.argmax(sizes), sizes.shape)
    return (float(sizes[rate, k]), int(k) + LOWEST, RATES / kept[rate])


def largest_patterns(recipe, path):
    """The largest spoke of a path, nm, and its periods on a turn; the same of arms."""
    first, last = (int(path.nodes[k, 1] // 360) for k in (0, -1))
    of_turns = errors(recipe, path, np.arange(first, last + 1))
    of_turns = of_turns[~np.all(np.isnan(of_turns), axis=1)]
    largest, largest_arms = (0.0, 0), (0.0, 0, 0.0)
    for window in windows(len(of_turns)):
        mean = np.nanmean(of_turns[window], axis=0)
        amplitudes = 2 * np.abs(np.fft.rfft(mean))[:HIGHEST + 1] / ANGLES
        amplitudes[HIGHEST] /= 1 + (2 * HIGHEST == ANGLES)
        k = LOWEST + int(np.argmax(amplitudes[LOWEST:]))
        largest = max(largest, (float(amplitudes[k]) * NM_PER_MM, k))
        largest_arms = max(largest_arms, arms(of_turns[window]))
    return largest, (largest_arms[0] * NM_PER_MM, *largest_arms[1:])


def main():
    """Command line."""
    program = str(Path(sys.argv[1]).resolve())
    figures = []
    for name, (recipe, changes) in CASES.items():
        with tempfile.TemporaryDirectory() as folder:
            sets = [word for change in changes for word in ("--set", change)]
            run = subprocess.run([program, "run", recipe, "-o", folder, *sets], capture_output=True, text=True)
            if run.returncode not in (0, TOLERANCE_EXCEEDED):
                raise SystemExit(f"{name}: exit {run.returncode}\n{run.stderr}")
            path = ToolPath.read(Path(folder) / "toolpath.csv")
        (amplitude, per_turn), (of_arms, arms_per_turn, turns) = largest_patterns(Recipe.read(recipe), path)
        file = str(recipe.relative_to(HERE.parents[2]))
        figures.append({"name": name, "recipe": file, "set": changes, "points": path.rows,
                        "amplitude_nm": amplitude, "per_turn": per_turn,
                        "arms": {"amplitude_nm": of_arms, "per_turn": arms_per_turn, "turns_apart": turns}})
        print(f"{name}: {amplitude:.3f} nm, {per_turn} a turn, {path.rows} points; arms {of_arms:.3f} nm, "
              f"{arms_per_turn} a turn, {turns:.1f} turns apart")
    (HERE / "spokes.json").write_text(json.dumps(figures, indent=2) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
