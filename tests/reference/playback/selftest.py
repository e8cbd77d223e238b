#!/usr/bin/env python3
"""Holds playback.py against closed forms and published figures, on paths made here by numpy.

    selftest.py            prints each figure beside what it is held against; exit 1 on a miss
"""

import math
import os
import sys
import tempfile
import time

import numpy as np

import playback
import surfaces

TAU = 2 * math.pi
RPM_500 = 500 / 60 * TAU  # rad/s
FAILED = []


def recipe(surface, compensator, aperture=5.0, nose=1.0, included=None):
    """A recipe with `surface` (a table) and the keys that playback reads."""
    tool = {"nose_radius": f"{nose!r} mm"}
    if included is not None:
        tool["included_angle"] = f"{included!r} deg"
    return playback.Recipe({"part": {"aperture": f"{aperture!r} mm"}, "surface": surface,
                            "tool": tool, "compensator": {"use": compensator}})


AST5 = {"use": "astigmatic", "k": "0.08 /mm"}


def locus_ast(theta, x, k, nose):
    """Z, Z_theta and Z_X of the z-compensated centre over k rho^2 sin 2theta (Newton's foot)."""
    a = 2 * k * np.sin(2 * theta)  # g_rho = a rho
    rho = x.copy()
    for _ in range(50):
        w = np.sqrt(1 + (a * rho) ** 2)
        rho -= (rho - nose * a * rho / w - x) / (1 - nose * a / w**3)
    w = np.sqrt(1 + (a * rho) ** 2)
    return a * rho**2 / 2 + nose / w, 2 * k * rho**2 * np.cos(2 * theta), a * rho


def spiral_rows(theta, x, x_rate, z, z_theta, z_x):
    """Rows of a path at constant speed; x_rate is dX/dtheta; all velocities exact."""
    one = np.ones_like(theta)
    return np.column_stack([theta / RPM_500, np.degrees(theta), x, z, math.degrees(RPM_500) * one,
                            x_rate * RPM_500, (z_theta + z_x * x_rate) * RPM_500, one])


def ast_rows(feed, step_deg, x_end, nose, k=0.08):
    """AST path outward from the centre, constant feed a revolution; nose 0: contact path."""
    count = math.floor(x_end / feed * 360 / step_deg)
    theta = np.radians(step_deg) * np.arange(count + 1)
    x = feed * theta / TAU
    return spiral_rows(theta, x, feed / TAU + 0 * theta, *locus_ast(theta, x, k, nose))


def held_feed_ast(law, rho, theta, nose=1.0, tolerance=1e-4, k=0.08):
    """Feed that holds the residual: `contact` or `centre` law (kappa, w at the foot)."""
    a = 2 * k * np.sin(2 * theta)
    w = np.sqrt(1 + (a * rho) ** 2)
    fit = 1 - nose * a / w**3
    return np.sqrt(8 * nose * tolerance * (1 / fit if law == "contact" else fit)) / w


def ast_law(feed_law, x_end):
    """(X, dX/dN) as functions of N for dX/dN = F(X), F the least feed over theta."""
    theta = np.linspace(0, TAU, 1441)[:, None]
    x = np.linspace(0, x_end, 4001)
    if feed_law == "centre":  # kappa and w belong to the foot of the centre at x
        rho = np.empty((len(theta), len(x)))
        for i, t in enumerate(theta[:, 0]):
            a = 2 * 0.08 * math.sin(2 * t)
            rho[i] = locus_ast(np.full_like(x, t), x, 0.08, 1.0)[2] / a if abs(a) > 1e-9 else x
    else:
        rho = x + 0 * theta
    feed = held_feed_ast(feed_law, rho, theta).min(axis=0)
    turns = np.concatenate([[0], np.cumsum(np.diff(x) * (1 / feed[1:] + 1 / feed[:-1]) / 2)])
    return turns, x, feed


def atpg_rows(feed_law, x_end, step_deg):
    """AST-5, z-direction, the fastest law that holds `feed_law` at every radius."""
    turns, grid, feed = ast_law(feed_law, x_end)
    theta = np.radians(step_deg) * np.arange(math.floor(turns[-1] * 360 / step_deg) + 1)
    x = np.interp(theta / TAU, turns, grid)
    rate = np.interp(x, grid, feed) / TAU
    return turns[-1], spiral_rows(theta, x, rate, *locus_ast(theta, x, 0.08, 1.0))


def bare_rows(x_of_theta, turns, step_deg=6.0):
    """A spiral whose Z does not matter (the residual uses the true Z)."""
    theta = np.radians(step_deg) * np.arange(round(turns * 360 / step_deg) + 1)
    rate = (x_of_theta(theta + 1e-4) - x_of_theta(theta - 1e-4)) / 2e-4
    return spiral_rows(theta, x_of_theta(theta), rate, *3 * (0 * theta,))


def check(what, value, expected, tolerance):
    """Prints a figure beside its reference; `tolerance` is absolute."""
    good = abs(value - expected) <= tolerance
    print(f"{'ok  ' if good else 'MISS'} {what}: {value:.6g} (held against {expected:.6g} ± {tolerance:.2g})")
    if not good:
        FAILED.append(what)


def check_surfaces():
    """Surfaces against other ways to write them, slopes, and the touch on known bodies."""
    rng = np.random.default_rng(7)
    x, y = rng.uniform(-100, 100, (2, 2000))
    sag = surfaces.SURFACES["off-axis-paraboloid"](
        {"vertex_radius": "915 mm", "off_axis_distance": "915 mm"})
    c = s = math.sqrt(0.5)
    b, q = 915 / c + s * c * x, c * c * x * x + y * y
    check("OAP rotation - closed formula, mm", np.abs(sag(x, y) - q / (b + np.sqrt(b * b - s * s * q))).max(), 0, 5e-13)
    torus = surfaces.SURFACES["toric"]({"radius_rotation": "70 mm", "radius_base": "70000 um"})
    ball = surfaces.SURFACES["conic"]({"use": "conic", "radius": "70 mm"})
    check("toric of equal radii - sphere, mm", np.abs(torus(x / 4, y / 4) - ball(x / 4, y / 4)).max(), 0, 1e-13)
    poly = surfaces.SURFACES["xy-polynomial"]({"terms": [[1, 1, 0.16]]})
    astig = surfaces.SURFACES["astigmatic"]({"k": "0.08 /mm"})
    check("2kxy as polynomial, mm", np.abs(poly(x, y) - astig(x, y)).max(), 0, 1e-10)
    theta, rho = rng.uniform(0, TAU, 500), rng.uniform(-2.5, 2.5, 500)
    bowl = recipe({"use": "conic", "radius": "1e1 mm"}, "z-direction")
    check("touch in a sphere - centre distance R - r, mm",
          np.abs(playback.first_touch(bowl, theta, rho) - (10 - np.sqrt(81 - rho**2))).max(), 0, 1e-12)
    ast = recipe(AST5, "z-direction")
    check("touch on AST-5 - Newton's foot, mm",
          np.abs(playback.first_touch(ast, theta, rho) - locus_ast(theta, rho, 0.08, 1.0)[0]).max(), 0, 1e-12)
    tight = recipe({"use": "xy-polynomial", "terms": [[1, 0, 1.0]]}, "normal", included=60.0)
    edge = math.radians(30)
    check("touch at the edge's end on a 45 deg plane, mm",
          float(playback.first_touch(tight, 0.0, np.array([0.3]))[0]), 0.3 + math.sin(edge) + math.cos(edge), 1e-12)


def check_touch_by_brute_force():
    """The touch against 2e5 positions of each nose, on every other surface, hills that compete included."""
    rng = np.random.default_rng(3)
    phi = np.linspace(-math.pi / 2, math.pi / 2, 200_001)
    array = {"use": "sinusoidal-array", "amplitude_x": "0.05 mm", "amplitude_y": "50 um",
             "frequency_x": "1 /mm", "frequency_y": "1 1/mm", "form": "product"}
    lens = {**array, "amplitude_x": "5 um", "amplitude_y": "5 um", "frequency_x": "0.4 /mm",
            "frequency_y": "0.4 /mm", "form": "sum"}
    toric = {"use": "toric", "radius_rotation": "60 mm", "radius_base": "45 mm"}
    oap = {"use": "off-axis-paraboloid", "vertex_radius": "915 mm", "off_axis_distance": "915 mm"}
    for surface, nose in ((array, 0.3), (array, 0.8), (lens, 1.0), (toric, 1.0), (oap, 1.04)):
        body = recipe(surface, "z-direction", aperture=20.0, nose=nose)
        theta, x = rng.uniform(0, TAU, 60), rng.uniform(0, 10, 60)
        brute = [np.max(body.profile(a)(b + nose * np.sin(phi)) + nose * np.cos(phi)) for a, b in zip(theta, x)]
        gap = playback.first_touch(body, theta, x) - brute
        check(f"touch - brute force, {surface['use']}, nose {nose}, mm", np.abs(gap).max(), 0, 3e-10)


def check_closing_by_brute_force():
    """The lowest that the nose can leave, against every position of the nose on every place of a
    lattice, on seams and beside them. Places a step of `h` apart miss the lowest by half of `h` times
    the slope at most."""
    lattice = {"use": "sinusoidal-array", "amplitude_x": "10 um", "amplitude_y": "10 um",
               "frequency_x": "1 /mm", "frequency_y": "1 /mm", "form": "sum"}
    nose, reach, h, steepest = 3.0, 0.3, 5e-5, 0.09
    body = recipe(lattice, "z-direction", aperture=3.0, nose=nose)
    off = h * np.arange(-round(reach / h), round(reach / h) + 1)
    for theta, s in ((0.79, 0.6), (0.79, 0.7071), (0.5, -0.55), (0.1, 0.5), (1.2, 0.2)):
        profile, lift = body.profile(theta), np.sqrt(nose**2 - off**2)
        centres = np.array([np.max(profile(s + x + off) + lift) for x in off])
        brute = np.min(centres - lift)
        found, _ = playback.closing_at(body, theta, np.array([s]), s - reach, s + reach, playback.SEAM_SCAN)
        above = (found[0] - profile(s)) * 1e6
        expected, bound = (brute - profile(s)) * 1e6, 0.5 * h * steepest * 1e6
        check(f"closing at {s} mm of {theta} rad, nm above the lattice", above, expected, bound)


def check_sign_and_place():
    """5 nm put into one row's Z comes back with its sign, at that row."""
    rows = ast_rows(0.025, 1.0, 2.5, 1.0)
    rows[20_000, 3] += 5e-6
    found = playback.interpolation_error(recipe(AST5, "z-direction"), playback.ToolPath(rows), stride=1)
    check("5 nm too high, nm", found["highest"], 5.0, 0.01)
    check("its place, deg", found["at"]["c_deg"], 20_000.0, 0.03)


def check_interpolation():
    """AST-5, constant feed f_min, 9 deg steps, exact velocities: 12.5 and 30.4 nm."""
    theta, rho = np.linspace(0, TAU, 7201)[:, None], np.linspace(0, 2.5, 501)
    feed = held_feed_ast("contact", rho, theta).min()
    check("revolutions at the constant minimum", 2.5 / feed, 101.11, 0.01)
    theta = np.radians(np.arange(0, 361, 9.0))
    for name, nose, expected in (("none", 0.0, 12.5), ("z-direction", 1.0, 30.4)):
        rim = np.full_like(theta, 2.5)
        turn = spiral_rows(theta, rim, 0 * rim, *locus_ast(theta, rim, 0.08, nose))
        found = playback.interpolation_error(recipe(AST5, name), playback.ToolPath(turn))
        check(f"9 deg, {name}, the turn at X = 2.5 itself, nm", found["max"], expected, 0.05)
        path = playback.ToolPath(ast_rows(feed, 9.0, 2.5, nose))
        found = playback.interpolation_error(recipe(AST5, name), path)
        # the last worst segment lies up to half a turn inside the rim
        check(f"9 deg, {name}, spiral, feed f_min = {feed:.6f}, nm", found["max"], expected, 0.01 * expected)
        print("     ", found)


def check_residual():
    """Cusps of flats, planes, bowls and AST-5."""
    flat = {"use": "xy-polynomial", "terms": []}
    for feed in (0.005, 0.028):
        path = playback.ToolPath(bare_rows(lambda t: feed * t / TAU, 2.4 / feed))
        for comp in ("z-direction", "none"):
            found = playback.residual(recipe(flat, comp), path)["max"]
            check(f"flat, feed {feed}, {comp}: / (f^2/8R)", found / (feed**2 / 8 * 1e6), 1, 0.001)
    feed = 0.02
    path = playback.ToolPath(bare_rows(lambda t: feed * t / TAU, 100))
    plane = recipe({"use": "xy-polynomial", "terms": [[1, 0, 1.0]]}, "z-direction")
    exact = (1 - math.sqrt(1 - feed**2 / 2)) * 1e6  # steepest section: passes sqrt(2) f apart
    check("45 deg plane along the normal, nm", playback.residual(plane, path)["max"], exact, 0.01)
    for law in ("contact", "centre"):
        check(f"bowl of 1.25 mm, {law} feed, nm", *bowl(law), 0.01)
    for law, x_end, expected in (("centre", 2.5, 100.0), ("centre", 2.871, 100.0), ("contact", 2.5, 105.0)):
        turns, rows = atpg_rows(law, x_end, 6.0)
        found = playback.residual(recipe(AST5, "z-direction"), playback.ToolPath(rows))
        check(f"AST-5, {law}-law feed to X = {x_end}, {turns:.2f} revolutions, nm", found["max"], expected, 0.5)
        print("     ", found)
    theta, rho, rate = contact_path_rows(2.5)
    rows = spiral_rows(theta, rho, rate, *locus_ast(theta, rho, 0.08, 0.0))
    found = playback.measure(recipe(AST5, "none"), playback.ToolPath(rows))
    check("AST-5, contact law, none, nm", found["residual_nm"]["max"], 100.0, 0.5)
    a = 0.16 * np.sin(2 * theta)  # normal compensation: X = rho - R g_rho / w
    w = np.sqrt(1 + (a * rho) ** 2)
    x = rho - a * rho / w
    x_rate = rate - (a * rate + 0.32 * np.cos(2 * theta) * rho) / w**3
    rows = spiral_rows(theta, x, x_rate, *locus_ast(theta, x, 0.08, 1.0))
    found = playback.measure(recipe(AST5, "normal"), playback.ToolPath(rows))
    check("AST-5, contact law, normal, nm", found["residual_nm"]["max"], 100.0, 0.5)
    print("     ", found)


def check_surface_error():
    """A flat part's scallops: f²/8R high, a parabola's RMS."""
    flat = recipe({"use": "xy-polynomial", "terms": [[1, 0, 0.0]]}, "none")
    feed = 0.02
    path = playback.ToolPath(bare_rows(lambda theta: feed * (theta / TAU - 2), 130))
    found = playback.surface_error(flat, path)
    check("scallop of a flat part, PV, nm", found["pv"], feed**2 / 8 * 1e6, 0.02)
    check("scallop of a flat part, RMS, nm", found["rms"], feed**2 / 8 * 1e6 * math.sqrt(0.2), 0.05)


def check_coverage():
    """A flat, a spiral from the axis: what its last pass leaves at the rim, 1.5 feeds at the axis."""
    flat, feed, turns = {"use": "xy-polynomial", "terms": []}, 0.02, 120
    path = playback.ToolPath(bare_rows(lambda t: feed * t / TAU, turns))
    for comp in ("z-direction", "none"):
        found = playback.coverage(recipe(flat, comp), path)
        # on the first section past the end the last pass lies nearly a turn further in
        away = 2.5 - feed * (turns - 1 + 1e-7 / 360)
        # the flank of that pass stands higher at the rim than the rim is from it
        check(f"rim of a flat, {comp}, nm", found["rim"], (1 - math.sqrt(1 - away**2)) * 1e6, 0.01)
        gap = feed * (0.5 + 179 / 180)
        check(f"centre of a flat, {comp}, nm", found["centre"], (1 - math.sqrt(1 - gap**2 / 4)) * 1e6, 0.01)


def bowl(law, radius=1.25):
    """Residual in a spherical bowl: as measured, and in closed form (nose 1 mm, 100 nm held).

    Centres lie on a sphere of radius b = R_bowl - 1; dX/dN = f0/w is a constant angle f0/b on it.
    """
    fit, b = 1 - 1 / radius, radius - 1
    f0 = math.sqrt(8e-4 * (1 / fit if law == "contact" else fit))
    path = playback.ToolPath(bare_rows(lambda t: b * np.sin(f0 / b * t / TAU), b / f0 * 1.2))
    body = recipe({"use": "conic", "radius": f"{radius} mm"}, "z-direction", aperture=2.1)
    half_chord = b * math.sin(f0 / b / 2)
    exact = radius - math.sqrt(b**2 - half_chord**2) - math.sqrt(1 - half_chord**2)
    return playback.residual(body, path)["max"], exact * 1e6


def contact_path_rows(x_end, step_deg=6.0):
    """AST-5 contact radii of the fastest contact law."""
    turns, grid, feed = ast_law("contact", x_end)
    theta = np.radians(step_deg) * np.arange(math.floor(turns[-1] * 360 / step_deg) + 1)
    rho = np.interp(theta / TAU, turns, grid)
    return theta, rho, np.interp(rho, grid, feed) / TAU


def check_file(rows_wanted=10_000):
    """A file with lead-in and lead-out, through the CSV reader, timed."""
    text = """[part]\naperture = "5 mm"\n[surface]\nuse = "astigmatic"\nk = "0.08 /mm"
[tool]\nnose_radius = "1 mm"\nincluded_angle = "150 deg"\n[compensator]\nuse = "z-direction"\n"""
    rows = ast_rows(0.025, 3.6, 2.5, 1.0)[:rows_wanted]
    lead = rows[[0]].copy(); lead[0, 0] -= 1; lead[0, 3] += 1; lead[0, 7] = 0
    tail = rows[[-1]].copy(); tail[0, 0] += 1; tail[0, 3] += 1; tail[0, 7] = 2
    with tempfile.TemporaryDirectory() as folder:
        recipe_file, path_file = os.path.join(folder, "r.toml"), os.path.join(folder, "toolpath.csv")
        with open(recipe_file, "w") as file:
            file.write(text)
        np.savetxt(path_file, np.vstack([lead, rows, tail]), "%.17g", ",", header=playback.COLUMNS, comments="")
        start = time.monotonic()
        found = playback.measure(playback.Recipe.read(recipe_file), playback.ToolPath.read(path_file))
        print(f"      {found}\n      {len(rows)} rows measured in {time.monotonic() - start:.1f} s")
    check("rows with leads", found["rows"], len(rows) + 2, 0)


if __name__ == "__main__":
    check_surfaces()
    check_touch_by_brute_force()
    check_closing_by_brute_force()
    check_sign_and_place()
    check_interpolation()
    check_residual()
    check_surface_error()
    check_coverage()
    check_file()
    sys.exit(1 if FAILED else 0)
