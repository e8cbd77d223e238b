"""Writes values.json: heights of the surfaces in models.py, by optiland and by prysm.

Neither package has all models, and optiland's biconic is another surface than Zemax's: the sum of
two conic sections, which agrees with Zemax's along x and along y only. There it is the reference.
A segment off the axis is optiland's conic, met by scipy's root search along the segment's normal;
a lens array is optiland's conic about the nearest of many lattice points, found by scipy's tree.

A case: the model, its parameters, who gave the heights, and x, y and z in mm.

Run: python values.py > values.json
"""

import json
from importlib.metadata import version

import numpy as np
from optiland.coordinate_system import CoordinateSystem
from optiland.geometries.biconic import BiconicGeometry
from optiland.geometries.chebyshev import ChebyshevPolynomialGeometry
from optiland.geometries.even_asphere import EvenAsphere
from optiland.geometries.forbes import (ForbesQ2dGeometry, ForbesQNormalSlopeGeometry,
                                        ForbesSurfaceConfig)
from optiland.geometries.odd_asphere import OddAsphere
from optiland.geometries.polynomial import PolynomialGeometry
from optiland.geometries.standard import StandardGeometry
from optiland.geometries.toroidal import ToroidalGeometry
from optiland.geometries.zernike import ZernikePolynomialGeometry
from prysm.polynomials import qpoly
from prysm.polynomials import Q2d, Qbfs, Qcon, cheby1, zernike_nm
from prysm.polynomials.zernike import ansi_j_to_nm, fringe_to_nm, noll_to_nm
from scipy import special
from scipy.optimize import brentq
from scipy.spatial import cKDTree

from models import MODELS, numbers



class DoubleFactorials:
    """What prysm takes from scipy, with (-1)!! = 1: newer versions of scipy give 0."""

    factorial = staticmethod(special.factorial)

    @staticmethod
    def factorial2(n):
        return 1.0 if n == -1 else special.factorial2(n)


qpoly.special = DoubleFactorials
HERE = CoordinateSystem()
FLAT = np.inf


def points(aperture):
    """The axis, and rings of points out to the rim, none of them on a line of symmetry."""
    x, y = [0.0], [0.0]
    for ring, part in enumerate([0.125, 0.375, 0.5625, 0.78125, 1.0]):
        for k in range(7):
            angle = 2 * np.pi * (k + 0.17 * ring + 0.06) / 7
            x.append(part * aperture * np.cos(angle))
            y.append(part * aperture * np.sin(angle))
    return np.array(x), np.array(y)


def dense(coefficients, step=1, first=1):
    """Coefficients as a list that begins with the power `first`."""
    powers = {int(power): value for power, value in coefficients.items()}
    return [powers.get(power, 0.0) for power in range(first, max(powers) + 1, step)]


def matrix(coefficients):
    terms = {numbers(key): value for key, value in coefficients.items()}
    out = np.zeros([max(key[axis] for key in terms) + 1 for axis in (0, 1)])
    for key, value in terms.items():
        out[key] = value
    return out


def even_asphere(p, x, y):
    yield "optiland", EvenAsphere(HERE, p.get("radius", FLAT), p.get("conic", 0.0),
                                  coefficients=dense(p["coefficients"], 2, 2)).sag(x, y)


def odd_asphere(p, x, y):
    yield "optiland", OddAsphere(HERE, p.get("radius", FLAT), p.get("conic", 0.0),
                                 coefficients=dense(p["coefficients"])).sag(x, y)


def biconic(p, x, y):
    surface = BiconicGeometry(HERE, p.get("radius_x", FLAT), p.get("radius_y", FLAT),
                              p.get("conic_x", 0.0), p.get("conic_y", 0.0))
    yield "optiland along x", (x, 0 * y, surface.sag(x, 0 * y))
    yield "optiland along y", (0 * x, y, surface.sag(0 * x, y))


def toroid_yz(p, x, y):
    coefficients = dense(p["coefficients"], 2, 2) if "coefficients" in p else None
    if "radius_rotation" in p:
        yield "optiland", ToroidalGeometry(HERE, p["radius_rotation"], p["radius"],
                                           p.get("conic", 0.0), coefficients).sag(x, y)
    else:
        yield "optiland", EvenAsphere(HERE, p["radius"], p.get("conic", 0.0),
                                      coefficients=coefficients).sag(0 * x, y)


def off_axis_conic(p, x, y):
    parent = StandardGeometry(HERE, p["vertex_radius"], p["conic"])
    distance = p["off_axis_distance"]
    height = parent.sag(distance, 0.0)
    normal = EvenAsphere(HERE, p["vertex_radius"], p["conic"])._surface_normal(distance, 0.0)
    nx, _, nz = normal
    cos, sin = abs(nz), -np.sign(nz) * nx

    def miss(z, x, y):
        return height + sin * x + cos * z - parent.sag(distance + cos * x - sin * z, y)

    found = [brentq(miss, -8.0, 8.0, (one, other), xtol=1e-15, rtol=1e-15)
             for one, other in zip(x, y)]
    yield "optiland and scipy", np.array(found)


def lenslet_array(p, x, y):
    count = np.arange(-12, 13)
    i, j = (grid.ravel() for grid in np.meshgrid(count, count))
    if p["layout"] == "square":
        centres = np.stack([i, j], axis=1) * p["pitch"]
    else:
        centres = np.stack([i + 0.5 * j, np.sqrt(3) / 2 * j], axis=1) * p["pitch"]
    _, nearest = cKDTree(centres).query(np.stack([x, y], axis=1))
    off = np.stack([x, y], axis=1) - centres[nearest]
    lens = StandardGeometry(HERE, p["radius"], p["conic"])
    yield "optiland and scipy", lens.sag(off[:, 0], off[:, 1])


def xy_polynomial(p, x, y):
    r = p["normalization_radius"]
    surface = PolynomialGeometry(HERE, FLAT, coefficients=matrix(p["coefficients"]))
    yield "optiland", surface.sag(x / r, y / r)


def zernike(p, x, y):
    r = p["normalization_radius"]
    usual = "peak" if p["indexing"] == "fringe" else "rms"
    norm = p.get("normalization", usual) == "rms"
    to_nm = {"noll": noll_to_nm, "fringe": fringe_to_nm, "osa": ansi_j_to_nm}[p["indexing"]]
    rho, theta = np.hypot(x, y) / r, np.arctan2(y, x)
    total = 0 * x
    for number, value in p["coefficients"].items():
        total = total + value * zernike_nm(*to_nm(int(number)), rho, theta, norm=norm)
    yield "prysm", total
    if p.get("normalization", usual) == usual:
        first = 0 if p["indexing"] == "osa" else 1
        kind = {"osa": "standard"}.get(p["indexing"], p["indexing"])
        surface = ZernikePolynomialGeometry(HERE, FLAT, zernike_type=kind, norm_radius=r,
                                            coefficients=dense(p["coefficients"], first=first))
        yield "optiland", surface.sag(x, y)


def forbes(p, x, y, departure):
    """The sphere of optiland with a departure along its normal."""
    if "radius" not in p:
        return departure
    square = (x * x + y * y) / p["radius"] ** 2
    return StandardGeometry(HERE, p["radius"], 0.0).sag(x, y) + departure / np.sqrt(1 - square)


def forbes_qbfs(p, x, y):
    u = np.hypot(x, y) / p["normalization_radius"]
    terms = {int(n): value for n, value in p["coefficients"].items()}
    yield "prysm", forbes(p, x, y, sum(value * Qbfs(n, u) for n, value in terms.items()))
    config = ForbesSurfaceConfig(p.get("radius", FLAT), 0.0, p["normalization_radius"], terms)
    z = ForbesQNormalSlopeGeometry(HERE, config).sag(x, y)
    # Beyond the normalisation radius, by rounding too, optiland has the sphere alone.
    yield "optiland", (x[u < 1], y[u < 1], z[u < 1])


def forbes_qcon(p, x, y):
    u = np.hypot(x, y) / p["normalization_radius"]
    terms = {int(n): value for n, value in p["coefficients"].items()}
    base = StandardGeometry(HERE, p.get("radius", FLAT), p.get("conic", 0.0)).sag(x, y)
    yield "prysm", base + sum(value * Qcon(n, u) for n, value in terms.items())


def forbes_q2d(p, x, y):
    u, theta = np.hypot(x, y) / p["normalization_radius"], np.arctan2(y, x)
    terms = {numbers(key): value for key, value in p["coefficients"].items()}
    departure = sum(value * Q2d(n, m, u, theta) for (n, m), value in terms.items())
    yield "prysm", forbes(p, x, y, departure)
    # Zemax and optiland write the order m first.
    named = {("b" if m < 0 else "a", abs(m), n): value for (n, m), value in terms.items()}
    config = ForbesSurfaceConfig(p.get("radius", FLAT), 0.0, p["normalization_radius"], named)
    z = ForbesQ2dGeometry(HERE, config).sag(x, y)
    # It moves all points out by a little: the axis by 1e-6 mm, and the rim beyond the polynomials.
    inside = (u > 0.01) & (u < 0.99)
    yield "optiland", (x[inside], y[inside], z[inside])


def chebyshev(p, x, y):
    half_x = p["normalization_x"]
    half_y = p.get("normalization_y", half_x)
    terms = {numbers(key): value for key, value in p["coefficients"].items()}
    yield "prysm", sum(value * cheby1(i, x / half_x) * cheby1(j, y / half_y)
                       for (i, j), value in terms.items())
    surface = ChebyshevPolynomialGeometry(HERE, FLAT, norm_x=half_x, norm_y=half_y,
                                          coefficients=matrix(p["coefficients"]))
    yield "optiland", surface.sag(x, y)


def cases():
    for model, params, aperture in MODELS:
        at_x, at_y = points(aperture)
        for source, heights in globals()[model.replace("-", "_")](params, at_x, at_y):
            x, y, z = heights if isinstance(heights, tuple) else (at_x, at_y, heights)
            assert np.all(np.isfinite(z)), (model, params, source)
            yield {"surface": model, "params": params, "source": source,
                   "x": list(map(float, x)), "y": list(map(float, y)), "z": list(map(float, z))}


if __name__ == "__main__":
    packages = ", ".join(f"{name} {version(name)}" for name in ["optiland", "prysm", "scipy"])
    made = {"script": "tests/reference/surfaces/values.py", "packages": packages}
    lines = ",\n".join(json.dumps(case) for case in cases())
    print(f'{{"made_by": {json.dumps(made)}, "cases": [\n{lines}\n]}}')
