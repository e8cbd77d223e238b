"""Makes text.ttf, the letters of drawings: a part of DejaVu Sans.

    python subset.py DejaVuSans.ttf

Needs fonttools. DejaVu Sans may be changed and passed on under its own licence, which is in
text.LICENSE, if the changed font has another name: this one is "turnpath text".
"""

import sys

from fontTools import subset
from fontTools.ttLib import TTFont

# Latin with its accents, Greek, and the signs and raised digits of titles and numbers.
LETTERS = [*range(0x20, 0x7F), *range(0xA0, 0x100), *range(0x391, 0x3CA), *map(ord, "⁰¹²³⁴⁵⁶⁷⁸⁹⁻−–…≤≥×·°µ")]

options = subset.Options(hinting=False, layout_features=[], notdef_outline=True, name_IDs=[1, 2])
options.drop_tables += ["FFTM", "GPOS", "GSUB", "kern"]
font = TTFont(sys.argv[1], recalcTimestamp=False)
subsetter = subset.Subsetter(options)
subsetter.populate(unicodes=LETTERS)
subsetter.subset(font)
for name in font["name"].names:
    if name.nameID == 1:
        name.string = "turnpath text"
font.save("text.ttf")
