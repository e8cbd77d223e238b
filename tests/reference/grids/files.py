"""Small maps in every format, and what they hold, for tests/reference/grids/files.

All maps sample one surface that has no symmetry, so that a wrong order of rows, a mirrored axis or
exchanged axes show. Each format is written here from its description, by code that shares nothing
with turnpath. prysm reads the binary file again, as a check of this script.

    python files.py         # needs numpy and prysm; writes into files/
"""

import json
import struct
from importlib.metadata import version
from pathlib import Path

import numpy as np

FOLDER = Path(__file__).parent / "files"
COLUMNS, ROWS = 8, 6
PITCH = (0.5, 0.4)


def height(x, y):
    """The surface, mm."""
    return 1e-3 * (0.3 + 0.2 * x - 0.5 * y + 0.1 * x * x - 0.07 * x * y + 0.03 * y**3)


def grid(middle=(0.0, 0.0)):
    """x, y and heights in rows from the bottom."""
    x = middle[0] + PITCH[0] * (np.arange(COLUMNS) - 0.5 * (COLUMNS - 1))
    y = middle[1] + PITCH[1] * (np.arange(ROWS) - 0.5 * (ROWS - 1))
    return x, y, height(x[None, :], y[:, None])


def entry(name, x, y, heights, **conventions):
    rows = [[None if np.isnan(h) else float(h) for h in row] for row in heights]
    return {"file": name, "x": x.tolist(), "y": y.tolist(), "heights": rows, **conventions}


HOLES = [(0, 2), (3, 7)]  # row from the bottom, column


def with_holes(heights):
    heights = heights.copy()
    for row, column in HOLES:
        heights[row, column] = np.nan
    return heights


def zemax(name, unit, flag, middle):
    x, y, heights = grid(middle)
    heights = with_holes(heights)
    lines = ["! a map, upper left point first"]
    lines.append(
        f"{COLUMNS} {ROWS} {PITCH[0] / unit!r} {PITCH[1] / unit!r} {flag} "
        f"{middle[0] / unit!r} {middle[1] / unit!r}"
    )
    for row in heights[::-1]:
        for z in row:
            # A hole has some number and the flag.
            lines.append("9.9 0 0 0 1" if np.isnan(z) else f"{float(z) / unit!r} 0 0 0 0")
    (FOLDER / name).write_text("\r\n".join(lines) + "\r\n")
    return entry(name, x, y, heights)


def code_v(name):
    """Whole numbers: SSZ of them are one wave."""
    x, y, heights = grid()
    wavelength, scale, no_data = 0.6328, 250000, -999999
    numbers = np.round(heights / (wavelength * 1e-3) * scale)
    heights = with_holes(numbers * (wavelength * 1e-3) / scale)
    lines = ["! a map", " Test map, 8 x 6"]
    lines.append(f"GRD {COLUMNS} {ROWS} SUR WVL {wavelength} SSZ {scale} NDA {no_data}")
    flat = [no_data if np.isnan(h) else int(n) for h, n in zip(heights[::-1].flat, numbers[::-1].flat)]
    # A line has any count of numbers, and a row of the grid need not end with it.
    lines += [" ".join(map(str, flat[k : k + 5])) for k in range(0, len(flat), 5)]
    (FOLDER / name).write_text("\n".join(lines) + "\n")
    return entry(name, x, y, heights, pitch=list(PITCH))


def xyz(name):
    """Millimetres and micrometres, in no order; one hole is missing, one is NaN."""
    x, y, heights = grid((3.0, -2.0))
    heights = with_holes(heights)
    points = [(a, b, heights[j, i]) for j, b in enumerate(y) for i, a in enumerate(x)]
    points = [points[k] for k in np.random.default_rng(4).permutation(len(points))]
    lines = ["# x mm, y mm, z um"]
    skipped = False
    for a, b, z in points:
        if np.isnan(z) and not skipped:
            skipped = True
            continue
        # Six digits: coordinates are rounded.
        lines.append(f"{a:.6g}, {b:.6g}, {'NaN' if np.isnan(z) else repr(float(z) * 1e3)}")
    (FOLDER / name).write_text("\n".join(lines) + "\n")
    return entry(name, x, y, heights, xy_unit="mm", z_unit="um")


def gsf(name, corner, unit, word):
    """32-bit floats, rows from the top; the corner is the upper left one, with y downwards."""
    middle = (0.0, 0.0)
    if corner:
        middle = (1.25, -0.5)
    x, y, heights = grid(middle)
    heights = with_holes(heights)
    sides = (COLUMNS * PITCH[0], ROWS * PITCH[1])
    header = f"Gwyddion Simple Field 1.0\nXRes = {COLUMNS}\nYRes = {ROWS}\n"
    header += f"XReal = {sides[0] / unit!r}\nYReal = {sides[1] / unit!r}\n"
    if corner:
        header += f"XOffset = {(middle[0] - sides[0] / 2) / unit!r}\n"
        header += f"YOffset = {-(middle[1] + sides[1] / 2) / unit!r}\n"
    header += f"Title = a map\nXYUnits = {word}\nZUnits = {word}\n"
    data = header.encode()
    data += b"\0" * (4 - len(data) % 4)
    values = (heights[::-1] / unit).astype("<f4")
    (FOLDER / name).write_bytes(data + values.tobytes())
    read = values.astype(float)[::-1] * unit
    return entry(name, x, y, read)


def metropro(name, magic, header_size, resolution, phases_in_wave):
    x, y, heights = grid()
    scale, obliquity, wavelength = np.float32(0.5), np.float32(1.0), np.float32(632.8e-9)
    square = np.float32(PITCH[0] * 1e-3)
    unit = float(scale) * float(obliquity) * float(wavelength) / phases_in_wave * 1e3
    phases = np.round(heights / unit)
    heights = with_holes(phases * unit)
    header = bytearray(header_size)

    def put(at, kind, value):
        struct.pack_into(">" + kind, header, at, value)

    put(0, "I", magic)
    put(4, "H", {0x6F: 1, 0x70: 2, 0x71: 3}[magic & 0xFF])
    put(6, "I", header_size)
    put(52, "H", 5)  # intensities
    put(54, "H", 3)
    put(56, "H", 2)
    put(60, "I", 5 * 3 * 2 * 2)
    put(68, "H", COLUMNS)
    put(70, "H", ROWS)
    put(72, "I", COLUMNS * ROWS * 4)
    put(164, "f", scale)
    put(168, "f", wavelength)
    put(176, "f", obliquity)
    put(184, "f", square)
    put(218, "H", resolution)
    intensities = np.arange(30).astype(">u2").tobytes()
    numbers = np.where(np.isnan(heights), 2147483640, phases)[::-1].astype(">i4")
    (FOLDER / name).write_bytes(bytes(header) + intensities + numbers.tobytes())
    # MetroPro has square pixels: both pitches are the first one.
    pitch = float(square) * 1e3
    x = pitch * (np.arange(COLUMNS) - 0.5 * (COLUMNS - 1))
    y = pitch * (np.arange(ROWS) - 0.5 * (ROWS - 1))
    return entry(name, x, y, heights)


def check(found):
    """prysm reads the same heights; it has the rows as the file has them."""
    from prysm.io import read_zygo_dat

    for one in found:
        if one["file"].startswith("metropro"):
            phase = read_zygo_dat(FOLDER / one["file"])["phase"][::-1] * 1e-6
            wanted = np.array(one["heights"], dtype=float)
            assert np.array_equal(np.isnan(phase), np.isnan(wanted))
            assert np.nanmax(np.abs(phase - wanted)) < 1e-6 * np.nanmax(np.abs(wanted))


if __name__ == "__main__":
    FOLDER.mkdir(exist_ok=True)
    found = [
        zemax("zemax-mm.DAT", 1.0, 0, (0.0, 0.0)),
        zemax("zemax-cm.DAT", 10.0, 1, (1.0, -2.0)),
        zemax("zemax-in.DAT", 25.4, 2, (0.0, 0.0)),
        zemax("zemax-m.DAT", 1e3, 3, (0.0, 0.0)),
        code_v("code-v.INT"),
        xyz("points.xyz"),
        gsf("field.gsf", True, 1e3, "m"),
        gsf("field-um.gsf", False, 1e-3, "um"),
        metropro("metropro-1.dat", 0x881B036F, 834, 0, 4096),
        metropro("metropro-2.dat", 0x881B0370, 834, 1, 32768),
        metropro("metropro-3.dat", 0x881B0371, 4096, 2, 131072),
    ]
    check(found)
    packages = ", ".join(f"{name} {version(name)}" for name in ["numpy", "prysm"])
    made = {"script": "tests/reference/grids/files.py", "packages": packages}
    text = ",\n".join(json.dumps(one) for one in found)
    text = f'{{"made_by": {json.dumps(made)}, "files": [\n{text}\n]}}\n'
    (FOLDER / "files.json").write_text(text)
