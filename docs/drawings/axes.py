"""Draws axes.svg, the picture of docs/axes.md.

    python3 docs/drawings/axes.py

Lengths are in px. The frame of each view has its origin where the spindle axis is, x to the right and
the second axis up.
"""

import math
import pathlib

WIDTH, HEIGHT = 940, 410
INK, PART, TOOL, PATH, TURN = "#30343b", "#c9d6e4", "#d08c1d", "#4a6fa5", "#a03b5c"


def line(points, colour=INK, width=1.5, more=""):
    text = " ".join(f"{x:.1f},{y:.1f}" for x, y in points)
    return f'<polyline points="{text}" fill="none" stroke="{colour}" stroke-width="{width}" {more}/>'


def text(x, y, words, anchor="start", colour=INK, weight="normal"):
    return (
        f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}" fill="{colour}" font-weight="{weight}">'
        f"{words}</text>"
    )


def on_part(x, y, words, anchor):
    """Words on the part, with room around them."""
    room = f'<g stroke="{PART}" stroke-width="5">{text(x, y, words, anchor)}</g>'
    return room + text(x, y, words, anchor)


def arrow(start, end, colour=INK, width=1.5):
    """A straight arrow."""
    return line([start, end], colour, width) + head(start, end, colour)


def head(before, end, colour):
    """The head of an arrow that comes from `before`."""
    angle = math.atan2(end[1] - before[1], end[0] - before[0])
    sides = [angle + turn for turn in (math.radians(155), -math.radians(155))]
    corners = [end] + [(end[0] + 9 * math.cos(side), end[1] + 9 * math.sin(side)) for side in sides]
    points = " ".join(f"{x:.1f},{y:.1f}" for x, y in corners)
    return f'<polygon points="{points}" fill="{colour}"/>'


def front(x0, y0, radius):
    """The part as the tool faces it: x to the right, y up, z towards the reader."""

    def at(rho, degrees):
        angle = math.radians(degrees)
        return x0 + rho * math.cos(angle), y0 - rho * math.sin(angle)

    yield text(x0, 34, "Seen from the tool", "middle", weight="bold")
    yield f'<circle cx="{x0}" cy="{y0}" r="{radius}" fill="{PART}" stroke="{INK}"/>'
    # Inward, C grows: in the frame of the part the tool runs from x towards y.
    spiral = [at(radius * (1 - k / 1080), k) for k in range(0, 1000, 6)]
    yield line(spiral, PATH, 1.2)
    yield arrow((x0, y0), at(radius + 34, 0))
    yield text(x0 + radius + 24, y0 + 20, "x")
    yield arrow((x0, y0), at(radius + 34, 90))
    yield text(x0 + 8, y0 - radius - 26, "y")
    for degrees, label in ((90, "90°"), (180, "180°"), (270, "270°")):
        x, y = at(radius - 36, degrees)
        yield on_part(x, y + 4, f"C = {label}", "middle")
    yield on_part(x0 + radius - 22, y0 - 8, "C = 0", "end")
    # The tool.
    x, y = at(radius, 0)
    yield f'<path d="M {x - 7:.1f} {y:.1f} l 9 -7 h 40 v 14 h -40 z" fill="{TOOL}" stroke="{INK}"/>'
    yield text(x + 50, y - 14, "tool, at +X", "middle", TOOL, "bold")
    # The part turns clockwise: y comes to the tool.
    turn = [at(radius + 16, degrees) for degrees in range(70, 22, -4)]
    yield line(turn, TURN, 2.5)
    yield head(turn[-2], turn[-1], TURN)
    yield text(*at(radius + 26, 48), "the part turns clockwise", colour=TURN)
    yield text(x0, y0 + radius + 34, "as C grows, the tool meets x, then y, then −x", "middle", TURN)


def side(x0, y0, radius, nose):
    """A section through the axis: x to the right, z up."""
    yield text(x0 + 40, 34, "In section, at C = 0", "middle", weight="bold")
    bowl = [(x0 + x, y0 - 0.0040 * x * x) for x in range(-radius, radius + 1, 4)]
    base = [(x0 + radius, y0 + 90), (x0 - radius, y0 + 90)]
    outline = " ".join(f"{x:.1f},{y:.1f}" for x, y in bowl + base)
    yield f'<polygon points="{outline}" fill="{PART}" stroke="{INK}"/>'
    yield line([(x0, y0 + 110), (x0, y0 - 190)], INK, 1, 'stroke-dasharray="8 4 2 4"')
    yield text(x0 - 6, y0 + 126, "spindle axis", "middle")
    yield line([(x0 - radius - 20, y0), (x0 + radius + 100, y0)], INK, 1, 'stroke-dasharray="3 3"')
    yield text(x0 + radius + 104, y0 + 4, "Z = 0")
    # The nose touches the bowl; its lowest point is the tip.
    touch, slope = 100, 2 * 0.0040 * 100
    length = math.hypot(1, slope)
    centre = (x0 + touch - nose * slope / length, y0 - 0.0040 * touch**2 - nose / length)
    yield (
        f'<path d="M {centre[0] - nose:.1f} {centre[1]:.1f} a {nose} {nose} 0 0 0 {2 * nose} 0 '
        f'v -70 h {-2 * nose} z" fill="{TOOL}" fill-opacity="0.55" stroke="{INK}"/>'
    )
    yield f'<circle cx="{centre[0]:.1f}" cy="{centre[1]:.1f}" r="3" fill="{INK}"/>'
    yield text(centre[0] + 7, centre[1] - 6, "centre")
    tip = (centre[0], centre[1] + nose)
    yield f'<circle cx="{tip[0]:.1f}" cy="{tip[1]:.1f}" r="3" fill="{TURN}"/>'
    yield text(tip[0] - 8, tip[1] + 15, "tip", "end", TURN)
    contact = (x0 + touch, y0 - 0.0040 * touch**2)
    yield f'<circle cx="{contact[0]:.1f}" cy="{contact[1]:.1f}" r="3" fill="{PATH}"/>'
    yield text(contact[0] + 6, contact[1] + 16, "contact", colour=PATH)
    yield arrow((x0, y0 - 150), (x0, y0 - 200))
    yield text(x0 - 8, y0 - 186, "+Z, towards the tool", "end")
    yield arrow((x0 + radius + 40, y0 - 26), (x0 + radius + 95, y0 - 26))
    yield text(x0 + radius + 62, y0 - 36, "+X", "middle")


def main():
    parts = [*front(190, 210, 120), *side(640, 250, 150, 42)]
    drawing = (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" width="{WIDTH}" '
        f'font-family="sans-serif" font-size="14">\n'
        f"<title>The axes of turnpath, seen from the tool and in section</title>\n"
        f'<rect width="{WIDTH}" height="{HEIGHT}" fill="white"/>\n' + "\n".join(parts) + "\n</svg>\n"
    )
    pathlib.Path(__file__).with_suffix(".svg").write_text(drawing)


main()
