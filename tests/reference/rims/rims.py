#!/usr/bin/env python3
"""What the nose leaves at the rims of steep caps, from the paths that turnpath makes of them.

    rims.py TURNPATH

runs the program on cap.toml for hollow and domed caps of several slopes, and keeps the figures in
rims.json beside this script. It shares no code with turnpath: a cap is a sphere, so distances from
it are those from its centre.

Lengths in mm, z towards the tool. At an angle theta the nose is a circle around each played (X, Z)
with C = theta, in the plane (rho, z). Of the lower halves of these circles,

- the machined point at the rim is the lowest point at rho = the rim's radius, and its height is its
  distance from the sphere;
- the nearest cut is the least distance of the sphere's own point at the rim from a circle.

The figure of a rim is the larger of both, over 120 angles, the angles at the path's ends, and a
finer search around the largest.

The residual is the highest place where the circles of neighbouring passes cross, over 360 angles.
"""

import json
import math
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
SPHERE, NOSE = 5.0, 0.5
CAPS_DEG = {True: (45, 68, 77, 80, 82), False: (45, 52)}  # hollow caps, and domes on which the nose finds the sphere
ANGLES = 120
DEGREES = 360  # angles of the residual, just behind each degree: there the path's ends decide nothing
BESIDE_DEG = 1e-7
TOLERANCE_EXCEEDED = 1  # turnpath's exit status when a path is made but holds no tolerance


def cases():
    """Name, aperture, signed radius and interpolation tolerance (nm) of each cap."""
    for hollow in (True, False):
        for slope in CAPS_DEG[hollow]:
            aperture = 2 * SPHERE * math.sin(math.radians(slope))
            name = f"{'hollow' if hollow else 'domed'} cap of {slope} deg"
            yield name, round(aperture, 6), SPHERE if hollow else -SPHERE, 20
    yield "hollow cap of 9.9 mm", 9.9, SPHERE, 200


def rows(program, case):
    """The rows of the path of a case: time_s, c_deg, x_mm, z_mm and the velocities."""
    _, aperture, radius, interpolation = case
    with tempfile.TemporaryDirectory() as folder:
        command = [program, "run", HERE / "cap.toml", "-o", folder,
                   "--set", f"part.aperture={aperture} mm", "--set", f"surface.radius={radius} mm",
                   "--set", f"tolerance.interpolation={interpolation} nm"]
        run = subprocess.run(command, capture_output=True, text=True)
        if run.returncode not in (0, TOLERANCE_EXCEEDED):
            raise SystemExit(f"{case[0]}: exit {run.returncode}\n{run.stderr}")
        return np.loadtxt(Path(folder) / "toolpath.csv", delimiter=",", skiprows=1)


def hermite(path, axis, k, s):
    """An axis (1 C, 2 X, 3 Z) at the fraction s of the segments after the rows k."""
    h = path[k + 1, 0] - path[k, 0]
    p0, p1 = path[k, axis], path[k + 1, axis]
    m0, m1 = path[k, axis + 3] * h, path[k + 1, axis + 3] * h
    return ((1 + 2 * s) * (1 - s)**2 * p0 + s * (1 - s)**2 * m0
            + s * s * (3 - 2 * s) * p1 + s * s * (s - 1) * m1)


def passes(path, theta_deg):
    """X and Z as played of every pass at an angle, in the order of time."""
    first = math.ceil((path[0, 1] - theta_deg) / 360)
    last = math.floor((path[-1, 1] - theta_deg) / 360)
    c = theta_deg + 360 * np.arange(first, last + 1)
    k = np.clip(np.searchsorted(path[:, 1], c, side="right") - 1, 0, len(path) - 2)
    low, high = np.zeros(len(c)), np.ones(len(c))
    for _ in range(60):
        s = (low + high) / 2
        early = hermite(path, 1, k, s) < c
        low, high = np.where(early, s, low), np.where(early, high, s)
    return hermite(path, 2, k, s), hermite(path, 3, k, s)


def circles(path, theta_deg):
    """Centres (X, Z) of the nose at an angle, as played, X negative on the opposite half."""
    (x, z), (opposite_x, opposite_z) = passes(path, theta_deg), passes(path, theta_deg + 180)
    return np.concatenate([x, -opposite_x]), np.concatenate([z, opposite_z])


def residual(path, rim, radius, theta_deg):
    """The highest cusp between passes at an angle. Z is that of a nose that touches the sphere: its
    centre is then on a sphere too. A cusp is on the part if its tip or the foot of its normal is."""
    x, _ = passes(path, theta_deg)
    sphere = math.copysign(1, radius)
    z = -sphere * np.sqrt((SPHERE - sphere * NOSE)**2 - x**2)  # from the sphere's centre
    dx, dz = np.diff(x), np.diff(z)
    apart = np.hypot(dx, dz)
    drop = np.sqrt(NOSE**2 - apart**2 / 4) / apart
    tip_x = (x[1:] + x[:-1]) / 2 + np.sign(dx) * dz * drop
    tip_z = (z[1:] + z[:-1]) / 2 - np.sign(dx) * dx * drop
    distance = np.hypot(tip_x, tip_z)
    foot_x = tip_x * SPHERE / distance
    on_part = (np.minimum(np.abs(tip_x), np.abs(foot_x)) <= rim) & (x[1:] * x[:-1] >= 0)
    height = np.where(on_part, sphere * (SPHERE - distance), -math.inf)
    return float(np.max(height))


def rim_height(path, rim, radius, theta_deg):
    """The height of the machined point at the rim, and the distance of the nearest cut."""
    x, z = circles(path, theta_deg)
    depth = math.sqrt(SPHERE**2 - rim**2)
    sphere = math.copysign(1, radius)
    edge = np.array([rim, radius - sphere * depth])
    over = np.abs(x - rim) < NOSE
    if not np.any(over):
        return math.inf, math.inf
    x, z = x[over], z[over]
    lowest = np.min(z - np.sqrt(NOSE**2 - (x - rim)**2))
    machined = sphere * (SPHERE - math.hypot(rim, lowest - radius))
    nearest = np.min(np.hypot(x - edge[0], z - edge[1])) - NOSE
    return machined, nearest


def figure(path, rim, radius):
    """The largest height over all angles, its angle, and both parts of it there."""
    def at(theta):
        return max(rim_height(path, rim, radius, theta))
    ends = [path[i, 1] + beside for i in (0, -1) for beside in (-BESIDE_DEG, BESIDE_DEG)]
    angles = list(360 / ANGLES * np.arange(ANGLES)) + [end % 360 for end in ends]
    best = max(angles, key=at)
    step = 360 / ANGLES / 10
    while step > 1e-6:
        best = max([best + step * i for i in range(-10, 11)], key=at)
        step /= 5
    return at(best), best % 360, rim_height(path, rim, radius, best)


def main():
    """Command line."""
    program, found = str(Path(sys.argv[1]).resolve()), []
    for case in cases():
        name, aperture, radius, interpolation = case
        path = rows(program, case)
        path = path[path[:, 7] == 1]
        height, theta, (machined, nearest) = figure(path, aperture / 2, radius)
        cusps = [residual(path, aperture / 2, radius, i + BESIDE_DEG) for i in range(DEGREES)]
        found.append({"name": name, "aperture_mm": aperture, "radius_mm": radius,
                      "interpolation_nm": interpolation,
                      "rim_nm": None if math.isinf(height) else height * 1e6,
                      "at_deg": theta, "machined_nm": machined * 1e6, "nearest_nm": nearest * 1e6,
                      "residual_nm": max(cusps) * 1e6})
        print(f"{name}: {height * 1e6:.1f} nm at {theta:.3f} deg, "
              f"machined {machined * 1e6:.1f}, nearest {nearest * 1e6:.1f}, residual {max(cusps) * 1e6:.1f}", flush=True)
    text = json.dumps(found, indent=2, allow_nan=False) + "\n"
    (HERE / "rims.json").write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
