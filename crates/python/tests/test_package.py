"""The program with a lab's installed strategies, the types, and the interpreters that are served."""

import importlib.metadata
import inspect
import json
import os
import subprocess
import sys
import textwrap
from pathlib import Path

import pytest
import tomli_w

import turnpath

LAB = '''
import numpy as np
import turnpath


@turnpath.sampler
def lab_even(path, block, count: int = 60):
    """As many points on each turn as the recipe says."""
    turns = [turnpath.subdivide(start, end, count) for start, end in block.turns()]
    return np.concatenate(turns)


@turnpath.surface
def lab_dish(x, y, k: turnpath.PerLength):
    return k * (x * x + y * y) + 0 * np.cos(x)


@turnpath.surface
def lab_step(x, y, depth: turnpath.Length):
    return depth * np.where(x < 1e9, np.cos(0.2 * x), 0.0)


@turnpath.sampler
def lab_endless(path, block):
    while True:
        pass


@turnpath.sampler
def lab_wrong(path, block):
    raise ValueError("not today")
'''


@pytest.fixture
def lab(tmp_path):
    """The environment of a process in which the package `lab` is installed."""
    site = tmp_path / "site"
    info = site / "lab-0.4.2.dist-info"
    info.mkdir(parents=True)
    (site / "lab_strategies.py").write_text(LAB)
    (info / "METADATA").write_text("Metadata-Version: 2.1\nName: lab\nVersion: 0.4.2\n")
    (info / "entry_points.txt").write_text("[turnpath.strategies]\nall = lab_strategies\n")
    path = os.pathsep.join([str(site), *filter(None, [os.environ.get("PYTHONPATH")])])
    return {**os.environ, "PYTHONPATH": path}


def program(lab, folder, *arguments):
    words = [sys.executable, "-m", "turnpath", *arguments]
    return subprocess.run(words, env=lab, cwd=folder, capture_output=True, text=True, timeout=300)


def recipe(part, folder, **tables):
    file = folder / "part.toml"
    file.write_text(tomli_w.dumps({**part, **tables}))
    return file.name


def test_the_program_lists_installed_strategies(lab, tmp_path):
    listed = program(lab, tmp_path, "list", "sampler")
    assert listed.returncode == 0, listed.stderr
    assert "lab-even" in listed.stdout and "As many points on each turn" in listed.stdout
    assert "equal-angle" in listed.stdout
    explained = program(lab, tmp_path, "explain", "lab-even")
    assert "count" in explained.stdout and "lab_strategies" in explained.stdout


def test_the_program_runs_a_recipe_with_installed_strategies(lab, tmp_path, part):
    name = recipe(
        part,
        tmp_path,
        sampler={"use": "lab-even", "count": 72},
        surface={"use": "lab-dish", "k": "0.01 /mm"},
    )
    ran = program(lab, tmp_path, "run", name, "-o", "out")
    assert ran.returncode == 0, ran.stdout + ran.stderr
    assert "may differ on another machine" in ran.stdout
    assert "sampler lab-even of lab_strategies" in " ".join(ran.stdout.split())
    assert (tmp_path / "out" / "summary.json").exists()
    again = program(lab, tmp_path, "verify", name, "out/toolpath.csv")
    assert again.returncode == 0, again.stdout + again.stderr


def test_the_program_fits_a_surface_and_says_so(lab, tmp_path, part):
    name = recipe(part, tmp_path, surface={"use": "lab-step", "depth": "3 um"})
    ran = program(lab, tmp_path, "run", name, "-o", "out")
    assert ran.returncode == 0, ran.stdout + ran.stderr
    assert "stands for the surface" in " ".join(ran.stdout.split())
    assert "it compares x or y" in " ".join(ran.stderr.split())


def test_the_program_names_a_strategy_that_raises(lab, tmp_path, part):
    name = recipe(part, tmp_path, sampler={"use": "lab-wrong"})
    ran = program(lab, tmp_path, "run", name, "-o", "out")
    text = " ".join(ran.stderr.split())
    assert ran.returncode == 3, text
    assert "`lab-wrong`" in text and "ValueError: not today" in text
    assert "lab_strategies.py, line" in text


def test_the_program_ends_where_a_strategy_does_not_come_back(lab, tmp_path, part):
    name = recipe(part, tmp_path, sampler={"use": "lab-endless"})
    ran = program(lab, tmp_path, "run", name, "-o", "out", "--plugin-time-limit", "1 s")
    text = " ".join(ran.stderr.split())
    assert ran.returncode == 3 and "`lab-endless`" in text, text


def test_the_program_fits_for_the_part_that_is_asked_for(lab, tmp_path, part):
    name = recipe(part, tmp_path, surface={"use": "lab-step", "depth": "3 um"})
    larger = program(lab, tmp_path, "check", name, "--set", "part.aperture=9 mm", "--format", "json")
    assert larger.returncode == 0, larger.stderr
    remarks = [one["kind"] for one in json.loads(larger.stdout)["remarks"]]
    assert "fitted_surface" in remarks and "beyond_data" not in remarks
    # The ending says nothing, and another file of this one may stand before it.
    (tmp_path / "part.recipe").write_text((tmp_path / name).read_text())
    (tmp_path / "lock.toml").write_text("format = 1\n")
    for words in (["check", "part.recipe"], ["check", "--plugins-lock", "lock.toml", name]):
        checked = program(lab, tmp_path, *words)
        assert checked.returncode == 0, checked.stderr


def test_a_package_that_cannot_be_loaded_is_named_and_left_out(lab, tmp_path, part):
    info = tmp_path / "site" / "broken-1.0.dist-info"
    info.mkdir()
    (info / "METADATA").write_text("Metadata-Version: 2.1\nName: broken\nVersion: 1.0\n")
    (info / "entry_points.txt").write_text("[turnpath.strategies]\nall = no_such_module\n")
    listed = program(lab, tmp_path, "list", "sampler")
    assert listed.returncode == 0, listed.stderr
    assert "lab-even" in listed.stdout and "`broken`" in listed.stderr
    assert "no_such_module" in listed.stderr and "Traceback" not in listed.stderr
    ran = program(lab, tmp_path, "run", recipe(part, tmp_path, sampler={"use": "lab-even"}), "-o", "out")
    assert ran.returncode == 0, ran.stderr


def test_a_recipe_that_is_no_text_has_the_status_of_files(lab, tmp_path):
    (tmp_path / "bad.toml").write_bytes(b"\xff\xfe\x00")
    checked = program(lab, tmp_path, "check", "bad.toml")
    assert checked.returncode == 4 and "Traceback" not in checked.stderr, checked.stderr
    assert "bad.toml" in checked.stderr


def test_a_name_that_no_recipe_could_choose_is_a_message(lab, tmp_path):
    text = LAB + "\n\n@turnpath.sampler(name='Über')\ndef odd(path, block):\n    return []\n"
    (tmp_path / "site" / "lab_strategies.py").write_text(text)
    listed = program(lab, tmp_path, "list", "sampler")
    assert listed.returncode == 3 and "Traceback" not in listed.stderr, listed.stderr
    assert "Über" in listed.stderr


def test_wrong_arguments_have_status_two(lab, tmp_path):
    assert program(lab, tmp_path, "run", "--no-such-option").returncode == 2


def test_every_public_name_is_documented_and_the_package_is_typed():
    folder = Path(turnpath.__file__).parent
    assert (folder / "py.typed").exists() and (folder / "_turnpath.pyi").exists()
    for name in turnpath.__all__:
        assert inspect.getdoc(getattr(turnpath, name)), name
    for view in (turnpath.Path, turnpath.Locus, turnpath.Task, turnpath.Block, turnpath.Cut):
        for name, member in vars(view).items():
            assert name.startswith("__") or inspect.getdoc(member), f"{view.__name__}.{name}"


def test_the_stubs_name_what_the_native_part_has():
    stubs = (Path(turnpath.__file__).parent / "_turnpath.pyi").read_text()
    native = turnpath._turnpath
    for name in dir(native):
        if name.startswith("__"):
            continue
        assert f"class {name}" in stubs or f"def {name}(" in stubs or f"{name}: " in stubs, name
        value = getattr(native, name)
        if inspect.isclass(value):
            for member in vars(value):
                if not member.startswith("__"):
                    assert f"def {member}(" in stubs, f"{name}.{member}"


def test_a_free_threaded_interpreter_is_refused():
    program = textwrap.dedent(
        """
        import sys
        sys._is_gil_enabled = lambda: False
        try:
            import turnpath
        except ImportError as error:
            print(error)
        """
    )
    ran = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True)
    assert "free-threaded" in ran.stdout


def test_the_version_is_that_of_the_distribution():
    try:
        installed = importlib.metadata.version("turnpath")
    except importlib.metadata.PackageNotFoundError:
        pytest.skip("the package is not installed as a wheel")
    assert installed == turnpath.__version__
