"""Checks the schema of recipes with taplo, as an editor would.

    python3 schema.py PROGRAM

Every ready recipe must pass, and each damage to one must be found. The damages are those of
tests/program/bad_recipes.rs that need no look at several values together.
"""

import pathlib
import re
import subprocess
import sys
import tempfile

REPOSITORY = pathlib.Path(__file__).resolve().parents[3]
BASE = REPOSITORY / "docs/recipes/astigmatic-5mm.toml"

# What is damaged: a pattern of the recipe, and what takes its place.
DAMAGES = {
    "a misspelt strategy": (r'"atpg"', '"atgp"'),
    "a strategy of another slot": (r'"z-direction"', '"triangle-rotary"'),
    "a misspelt key": (r"nose_radius", "nose_radios"),
    "a misspelt table": (r"\[spindle\]", "[spinddle]"),
    "a key of another strategy": (r'max_step = "45 deg"', 'max_step = "45 deg"\nspacing = "1 mm"'),
    "a unit of another quantity": (r'nose_radius = "1 mm"', 'nose_radius = "8 ms"'),
    "an unknown unit": (r'nose_radius = "1 mm"', 'nose_radius = "8 furlong"'),
    "no unit": (r'max_step = "45 deg"', "max_step = 45"),
    "no unit in a text": (r'max_step = "45 deg"', 'max_step = "45"'),
    "a missing parameter": (r'k = "0.08 /mm"\n', ""),
    "a missing table": (r'\[tool\]\n(.+\n)+', ""),
    "a missing strategy": (r'use = "z-direction"\n', ""),
    "a length below zero": (r'aperture = "5 mm"', 'aperture = "-5 mm"'),
    "a length of zero": (r'aperture = "5 mm"', 'aperture = "0.0 mm"'),
    "two points": (r'aperture = "5 mm"', 'aperture = "5.0.1 mm"'),
    "a comma": (r'aperture = "5 mm"', 'aperture = "5,5 mm"'),
    "a word that is not one of these": (r'"inward"', '"inwards"'),
    "a text in place of a table": (r'\[velocity\]\nuse = "triangle-rotary"', 'velocity = "triangle-rotary"'),
    "a number in place of a text": (r'name = ".+"', "name = 5"),
    "another format": (r"format = 1", "format = 2"),
    "an unknown post": (r'"pmac-pvt"', '"fanuc"'),
    "an unknown data file": (r'"csv"', '"xlsx"'),
    "a table of an unknown post": (r"\[output\]", "[output.fanuc]\n[output]"),
    "a limit of another quantity": (r"\[output\]", '[machine]\nz_velocity = "1 m"\n[output]'),
    "a rough path without an allowance": (r"\[output\]", "[passes.rough]\n[output]"),
    "a list of nothing to compare": (r"\[output\]", "[ablation]\nsampler = []\n[output]"),
}


def passes(schema, recipe):
    """Whether taplo finds nothing, and what it says."""
    call = ["taplo", "lint", "--schema", schema.as_uri(), str(recipe)]
    answer = subprocess.run(call, capture_output=True, text=True)
    return answer.returncode == 0, answer.stderr


def main():
    program = pathlib.Path(sys.argv[1]).resolve()
    wrong = []
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        schema = folder / "schema.json"
        text = subprocess.run([program, "schema"], check=True, capture_output=True, text=True).stdout
        schema.write_text(text)
        recipes = sorted((REPOSITORY / "docs/recipes").rglob("*.toml"))
        recipes.append(REPOSITORY / "cli/src/commands/init.toml")
        for recipe in recipes:
            fine, said = passes(schema, recipe)
            if not fine:
                wrong.append(f"{recipe.name} does not pass:\n{said}")
        base = BASE.read_text()
        for damage, (pattern, place) in DAMAGES.items():
            damaged, times = re.subn(pattern, place, base, count=1)
            if times != 1:
                wrong.append(f"{damage}: nothing to damage")
                continue
            file = folder / "damaged.toml"
            file.write_text(damaged)
            if passes(schema, file)[0]:
                wrong.append(f"{damage}: not found")
    print(f"{len(recipes)} recipes, {len(DAMAGES)} damages")
    if wrong:
        sys.exit("\n".join(wrong))


main()
