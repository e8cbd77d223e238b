"""Writes files/*.zmx, and lens.json: heights of their surfaces by programs that read them.

The files are made here, from the tables "Parameter definitions" of the OpticStudio help and from
what open readers do; none is a copy. They are read by optiland's and by ray-optics' readers. What
neither reads is built from the numbers of this script: optiland's geometries for TOROIDAL, XASPHERE,
XPOLYNOM, SZERNSAG and FZERNSAG, and the formula of the help for BICONICX. Both read toroids, and wrongly:
optiland 0.6.3 takes PARM 2 for PARM 1, and ray-optics 0.9.8 puts the terms behind ten zeros.

A case: the file, the arguments of the import, the grid and heights of its surface, in mm, as the
tool sees them: on the side of -z of the design, x and z have their signs changed. With a decentred
aperture the middle of the aperture is the origin.

Needs optiland 0.6.3 and rayoptics 0.9.8. Run: python lens.py > lens.json
"""

import json
import sys
import warnings
from importlib.metadata import version
from pathlib import Path

import numpy as np

warnings.filterwarnings("ignore")
from optiland.coordinate_system import CoordinateSystem  # noqa: E402
from optiland.fileio.zemax.reader.converter import ZemaxToOpticConverter  # noqa: E402
from optiland.geometries.even_asphere import EvenAsphere  # noqa: E402
from optiland.geometries.polynomial import PolynomialGeometry  # noqa: E402
from optiland.geometries.standard import StandardGeometry  # noqa: E402
from optiland.geometries.toroidal import ToroidalGeometry  # noqa: E402
from optiland.geometries.zernike import ZernikePolynomialGeometry  # noqa: E402
from rayoptics.zemax.zmxread import read_lens_file  # noqa: E402

FILES = Path(__file__).resolve().parent / "files"
GRID = 9  # points along each side of the square around the aperture
UNITS = {"MM": 1.0, "CM": 10.0, "IN": 25.4, "METER": 1000.0}
HERE = CoordinateSystem()
MIRROR = "GLAS MIRROR 0 0 1.5 40 0 0 0 0 0 0"
GLASS = "GLAS N-BK7 0 0 1.5168 64.17 0 0 0 0 0 0"
HEAD = """VERS 191106 2 123456
MODE SEQ
NAME {name}
NOTE 0 made by tests/reference/lens/lens.py
PFIL 0 0 0
LANG 0
UNIT {unit} X W X CM MR CPMM
ENPD 10
ENVD 20 1 0
GFAC 0 0
GCAT SCHOTT
RAIM 0 0 1 1 0 0 0 0 0 1
PUSH 0 0 0 0 0 0
SDMA 0 1 0
FTYP 0 0 1 1 0 0 0 0
ROPD 2
PICB 1
XFLN 0
YFLN 0
FWGN 1
WAVM 1 0.55 1
PWAV 1
POLS 1 0 1 0 0 1 0
GLRS 1 0
GSTD 0 100 0 0 0 0 0 0 0 0 0
"""
TAIL = """TOL TOFF   0   0              0              0   0 0 0 0 0
MNUM 1 1
MOFF   0   1 "" 0 0 0 1 1 0 0.0 "" 0
"""


def block(number, kind, lines):
    """The lines of a surface."""
    usual = ["HIDE 0 0 0 0 0 0 0 0 0 0", "MIRR 2 0", f"SLAB {number + 1}"]
    end = ["POPS 0 0 0 0 0 0 0 0 1 1 1 1 0 0 0 0"]
    return "".join(f"  {line}\n" for line in [f"TYPE {kind}", *usual, *lines, *end])


def curved(radius, conic=0.0):
    return [f'CURV {1 / radius!r} 0 0 0 0 ""', f"CONI {conic!r}"]


def parm(values):
    return [f"PARM {index} {value!r}" for index, value in values.items()]


def xdat(normalization, values):
    rows = {1: max(values), 2: normalization}
    rows |= {n + 2: values.get(n, 0.0) for n in range(1, max(values) + 1)}
    return [f'XDAT {n} {value:.17E} 0 0 1.000000000000E+000 0.000000000000E+000 0 ""'
            for n, value in rows.items()]


def design(name, unit, surfaces):
    """The text of a file; the object and the image are planes."""
    planes = ['CURV 0.0 0 0 0 0 ""', "DISZ INFINITY", 'DIAM 0 0 0 0 1 ""']
    image = ['CURV 0.0 0 0 0 0 ""', "DISZ 0", 'DIAM 1 0 0 0 1 ""']
    surfaces = [("STANDARD", planes), *surfaces, ("STANDARD", image)]
    blocks = [f"SURF {n}\n{block(n, *one)}" for n, one in enumerate(surfaces)]
    return (HEAD.format(name=name, unit=unit) + "".join(blocks) + TAIL).replace("\n", "\r\n")


def optiland(file, number, _):
    geometry = ZemaxToOpticConverter({}).read(str(file)).surfaces[number].geometry
    return lambda x, y: np.array([float(geometry.sag(a, b)) for a, b in zip(x, y)])


def ray_optics(file, number, _):
    model, _ = read_lens_file(file, do_update=False)
    profile = model["seq_model"].ifcs[number].profile
    profile.update()
    return lambda x, y: np.array([profile.sag(a, b) for a, b in zip(x, y)])


# What no package reads right, from the numbers of this script.


def toroid(*_):
    terms = [TOROID.get(index, 0.0) for index in range(2, 9)]
    return ToroidalGeometry(HERE, TOROID[1], 55.0, -0.6, terms).sag


def even_terms(radius, conic, terms):
    powers = [terms.get(power, 0.0) for power in range(2, max(terms) + 1, 2)]
    return EvenAsphere(HERE, radius, conic, coefficients=powers).sag


EVEN = {2: 1.5e-10, 3: -2e-13, 5: 4e-20}
ODD = {1: 0.002, 3: -0.0015, 4: 0.0005, 7: 2e-6}
TOROID = {1: 80.0, 2: 1e-5, 3: -3e-7, 4: 2e-10}
EXTENDED = {1: 0.003, 2: -0.0021, 4: 0.0004, 9: 2e-5}
EXTENDED_ODD = {1: 0.002, 3: -0.0021, 6: 0.0004, 11: 2e-5}
POLYNOMIAL = {1: 0.001, 2: -0.002, 3: 0.013, 4: -0.02, 5: 0.031, 6: 0.004, 7: -0.003, 8: 0.002,
              12: 1e-3, 13: -7e-4, 18: 3e-4}
POWERS = {1: (1, 0), 2: (0, 1), 3: (2, 0), 4: (1, 1), 5: (0, 2), 6: (3, 0), 7: (2, 1), 8: (1, 2),
          12: (2, 2), 13: (1, 3), 18: (2, 3)}
ZERNIKE = {1: 0.0004, 2: -0.0011, 3: 0.0007, 4: 0.0021, 5: -0.0013, 6: 0.0009, 7: 0.0005,
           8: -0.0004, 9: 0.0003, 10: -0.0006, 11: 0.0008, 12: 2e-4, 13: -1e-4, 22: 1e-4}


def extended_asphere(*_):
    return even_terms(90.0, -0.7, {2 * n: value / 12.5 ** (2 * n) for n, value in EXTENDED.items()})


def polynomial(*_):
    matrix = np.zeros([4, 4])
    for number, value in POLYNOMIAL.items():
        matrix[POWERS[number]] = value
    base = StandardGeometry(HERE, -150.0, 0.3)
    terms = PolynomialGeometry(HERE, np.inf, coefficients=matrix)
    return lambda x, y: base.sag(x, y) + terms.sag(x / 15.0, y / 15.0)


def zernike(*_, kind="noll"):
    base = even_terms(-200.0, -1.0, {4: 1e-6, 6: -2e-9})
    listed = [ZERNIKE.get(number, 0.0) for number in range(1, 23)]
    terms = ZernikePolynomialGeometry(HERE, np.inf, zernike_type=kind, norm_radius=20.0,
                                      coefficients=listed)
    return lambda x, y: base(x, y) + terms.sag(x, y)


def fringe(*_):
    return zernike(kind="fringe")


def biconic(*_):
    cx, kx, cy, ky = 1 / -60.0, -0.4, 1 / -45.0, 0.6

    def sag(x, y):
        root = np.sqrt(1 - (1 + kx) * (cx * x) ** 2 - (1 + ky) * (cy * y) ** 2)
        return (cx * x * x + cy * y * y) / (1 + root)
    return sag


WHO = {"toroid": "optiland's geometry", "extended_asphere": "optiland's geometry",
       "polynomial": "optiland's geometry", "zernike": "optiland's geometry",
       "fringe": "optiland's geometry",
       "biconic": "the formula of the help"}


def edge(radius):
    return f'DIAM {radius} 1 0 0 1 ""'


# File, encoding, unit, surfaces, the number of the surface, whether the tool stands on the side of
# -z, the aperture's radius and middle in the file's unit, further arguments, and who gives heights.
CASES = [
    ("conic-mirror", "utf-16", "MM",
     [("STANDARD", ["STOP", "COMM primary, 80 mm", *curved(-600.0, -1.05), "DISZ -280", MIRROR,
                    edge(40)])],
     1, True, 40.0, (0, 0), [], [optiland, ray_optics]),
    ("even-asphere-inches", "utf-8", "IN",
     [("EVENASPH", [*curved(2.5, -0.8), *parm({1: 0, 2: -1.3e-3, 3: 2e-4, 4: -1e-5}), "DISZ 0.2",
                    GLASS, edge(0.5)]),
      ("STANDARD", ['CURV 0.0 0 0 0 0 ""', "DISZ 4", edge(0.5)])],
     1, True, 0.5, (0, 0), [], [optiland, ray_optics]),
    ("odd-asphere-cm", "latin-1", "CM",
     [("STANDARD", ["COMM Vorderfläche", *curved(9.0), "DISZ 0.5", GLASS, edge(1.2)]),
      ("ODDASPHE", [*curved(-6.0, -0.5), *parm(ODD), "DISZ 10", "CLAP 0.2 1.1 0",
                    edge(1.2)])],
     2, False, 1.1, (0, 0), ["--surface", "2"], [optiland]),
    ("secondary-metres", "utf-8", "METER",
     [("STANDARD", ["STOP", *curved(-2.0, -1.0), "DISZ -0.75", MIRROR, edge(0.1)]),
      ("STANDARD", ["COMM secondary", *curved(-0.7, -2.2), "DISZ 0.9", MIRROR, edge(0.03)])],
     2, False, 0.03, (0, 0), ["--surface", "2"], [optiland, ray_optics]),
    ("off-axis-asphere", "utf-16", "MM",
     [("COORDBRK", ['CURV 0.0 0 0 0 0 ""', *parm({1: 0.0, 2: -45.0, 3: 0.0}), "DISZ 0"]),
      ("EVENASPH", ["STOP", "COMM segment", *curved(-600.0, -1.0), *parm(EVEN), "DISZ -280",
                    MIRROR, edge(75), "CLAP 0 30 0", "OBDC 5.0 45.0"])],
     2, True, 30.0, (5.0, 45.0), ["--surface", "2"], [ray_optics]),
    ("toroid", "utf-8", "MM",
     [("TOROIDAL", [*curved(55.0, -0.6), *parm(TOROID), "DISZ 3", GLASS, edge(12)]),
      ("STANDARD", ['CURV 0.0 0 0 0 0 ""', "DISZ 100", edge(12)])],
     1, True, 12.0, (0, 0), [], [toroid]),
    ("biconic", "utf-8", "MM",
     [("BICONICX", [*curved(-45.0, 0.6), *parm({1: -60.0, 2: -0.4}), "DISZ -50", MIRROR,
                    edge(10)])],
     1, True, 10.0, (0, 0), [], [biconic]),
    ("extended-asphere", "utf-8", "MM",
     [("XASPHERE", [*curved(90.0, -0.7), *xdat(12.5, EXTENDED), "DISZ 3", GLASS, edge(12)]),
      ("STANDARD", ['CURV 0.0 0 0 0 0 ""', "DISZ 100", edge(12)])],
     1, True, 12.0, (0, 0), [], [extended_asphere]),
    ("extended-odd-asphere", "utf-8", "MM",
     [("XOSPHERE", [*curved(90.0, -0.7), *xdat(1.0, {n: v / 12.5 ** n
                                                     for n, v in EXTENDED_ODD.items()}),
                    "DISZ 3", GLASS, edge(12)]),
      ("STANDARD", ['CURV 0.0 0 0 0 0 ""', "DISZ 100", edge(12)])],
     1, True, 12.0, (0, 0), [], [ray_optics]),
    ("extended-polynomial", "utf-16", "MM",
     [("XPOLYNOM", [*curved(-150.0, 0.3), *xdat(15.0, POLYNOMIAL), "DISZ -100", MIRROR,
                    edge(20), "CLAP 0 12 0", "OBDC -3.0 4.0"])],
     1, True, 12.0, (-3.0, 4.0), [], [polynomial]),
    ("zernike", "utf-8", "MM",
     [("SZERNSAG", [*curved(-200.0, -1.0), *parm({0: 0, 2: 1e-6, 3: -2e-9, 9: 0, 10: 0}),
                    *xdat(20.0, ZERNIKE), "DISZ -100", MIRROR, edge(18)])],
     1, True, 18.0, (0, 0), [], [zernike]),
    ("zernike-from-behind", "utf-8", "MM",
     [("STANDARD", ['CURV 0.0 0 0 0 0 ""', "DISZ 3", GLASS, edge(20)]),
      ("SZERNSAG", [*curved(-200.0, -1.0), *parm({0: 1, 2: 1e-6, 3: -2e-9}),
                    *xdat(20.0, ZERNIKE), "DISZ 100", edge(20), "CLAP 0 10 0", "OBDC 2.0 -6.0"])],
     2, False, 10.0, (2.0, -6.0), [], [zernike]),
    ("fringe", "utf-8", "MM",
     [("FZERNSAG", [*curved(-200.0, -1.0), *parm({0: 0, 2: 1e-6, 3: -2e-9, 9: 0, 10: 0}),
                    *xdat(20.0, ZERNIKE), "DISZ -100", MIRROR, edge(18)])],
     1, True, 18.0, (0, 0), [], [fringe]),
    ("fringe-from-behind", "utf-8", "MM",
     [("STANDARD", ['CURV 0.0 0 0 0 0 ""', "DISZ 3", GLASS, edge(20)]),
      ("FZERNSAG", [*curved(-200.0, -1.0), *parm({0: 1, 2: 1e-6, 3: -2e-9}),
                    *xdat(20.0, ZERNIKE), "DISZ 100", edge(20), "CLAP 0 10 0", "OBDC 2.0 -6.0"])],
     2, False, 10.0, (2.0, -6.0), [], [fringe]),
]


def case(name, encoding, unit, surfaces, number, from_minus_z, radius, middle, words, readers):
    """Writes the file, and gives the heights."""
    file = FILES / f"{name}.zmx"
    file.write_bytes(design(name, unit, surfaces).encode(encoding))
    half = np.linspace(-radius, radius, GRID)
    y, x = (grid.ravel() for grid in np.meshgrid(half, half, indexing="ij"))
    sign = -1.0 if from_minus_z else 1.0
    scale = UNITS[unit]
    heights = []
    own = (optiland, ray_optics)
    for reader in readers:
        sag = reader(file, number, unit)
        at_middle = sag(np.array([middle[0]]), np.array([middle[1]]))[0] if any(middle) else 0.0
        z = sign * (sag(sign * x + middle[0], y + middle[1]) - at_middle) * scale
        assert np.all(np.isfinite(z)), name
        heights.append({"by": reader.__name__ if reader in own else WHO[reader.__name__], "z": [float(one) for one in z]})
    return {"file": f"{name}.zmx", "words": words, "grid": GRID, "half": radius * scale,
            "decentred": any(middle), "heights": heights}


def main():
    """All files and all heights."""
    FILES.mkdir(exist_ok=True)
    packages = ", ".join(f"{name} {version(name)}" for name in ("optiland", "rayoptics", "numpy"))
    made = {"script": "tests/reference/lens/lens.py", "packages": packages}
    json.dump({"made_by": made, "cases": [case(*one) for one in CASES]}, sys.stdout, indent=1)
    print()


if __name__ == "__main__":
    main()
