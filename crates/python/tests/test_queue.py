"""An ablation in parts, as a queue makes it: each run in a process of its own."""

import json
import os
import subprocess
import sys
import textwrap

import pytest
import tomli_w

import turnpath

LAB = """
import numpy as np
import turnpath


@turnpath.sampler
def lab_even(path, block, count: int = 60):
    return np.concatenate([turnpath.subdivide(*turn, count) for turn in block.turns()])


@turnpath.sampler
def lab_wrong(path, block):
    raise ValueError("not today")
"""
VARY = {"sampler": [{"use": "lab-even"}, {"use": "lab-even", "count": 90}, {"use": "lab-wrong"}]}

JOB = """
import sys, turnpath, lab_strategies
key, recipe, folder = sys.argv[1:]
turnpath.run_of(key, recipe, strategies=[lab_strategies], folder=folder)
"""


@pytest.fixture
def lab(tmp_path, part):
    """A folder with a recipe and a module of strategies, and the environment of its jobs."""
    part["part"]["aperture"] = "3 mm"
    (tmp_path / "lab_strategies.py").write_text(LAB)
    (tmp_path / "part.toml").write_text(tomli_w.dumps({**part, "ablation": VARY}))
    path = os.pathsep.join([str(tmp_path), *filter(None, [os.environ.get("PYTHONPATH")])])
    return {**os.environ, "PYTHONPATH": path}


@pytest.fixture
def installed_lab(lab, tmp_path):
    """The same, with the module in an installed package."""
    info = tmp_path / "lab-0.4.2.dist-info"
    info.mkdir()
    (info / "METADATA").write_text("Metadata-Version: 2.1\nName: lab\nVersion: 0.4.2\n")
    (info / "entry_points.txt").write_text("[turnpath.strategies]\nall = lab_strategies\n")
    return lab


def called(lab, folder, *words):
    words = [sys.executable, *words]
    return subprocess.run(words, env=lab, cwd=folder, capture_output=True, text=True, timeout=300)


def test_a_sweep_of_the_program_has_installed_strategies(installed_lab, tmp_path):
    """What the scripts of docs/queues do, with ``python -m turnpath`` for ``turnpath``."""
    program = ["-m", "turnpath", "ablate", "part.toml"]

    def ablate(*words):
        return called(installed_lab, tmp_path, *program, "-o", "out", *words)

    keys = ablate("--plan=open").stdout.split()
    assert len(keys) == 4
    statuses = [ablate("--only", key).returncode for key in keys]
    assert statuses == [0, 0, 0, 3]
    states = [run["state"] for run in json.loads(ablate("--plan").stdout)["runs"]]
    assert states == ["done", "done", "done", "failed"]
    merged = ablate("--merge", "--format", "json")
    assert merged.returncode == 1, merged.stderr
    apart = json.loads(merged.stdout)["runs"]
    whole = called(installed_lab, tmp_path, *program, "-o", "other", "--format", "json")
    for one, other in zip(apart, json.loads(whole.stdout)["runs"]):
        assert one["varied"] == other["varied"]
        assert one.get("control_points") == other.get("control_points")
        assert one.get("path") == other.get("path")


def test_a_sweep_in_python_is_planned_made_elsewhere_and_merged(lab, tmp_path, monkeypatch):
    monkeypatch.syspath_prepend(str(tmp_path))
    monkeypatch.delitem(sys.modules, "lab_strategies", raising=False)
    import lab_strategies

    recipe, folder = tmp_path / "part.toml", tmp_path / "out"
    given = {"strategies": [lab_strategies], "folder": folder}
    runs = turnpath.plan(recipe, **given)
    assert [run["index"] for run in runs] == [0, 1, 2, 3]
    assert {run["state"] for run in runs} == {"missing"} and not folder.exists()
    assert "lab-even" in runs[1]["varied"]["sampler"]
    for run in runs[1:]:
        job = called(lab, tmp_path, "-c", textwrap.dedent(JOB), run["key"], str(recipe), str(folder))
        assert (job.returncode == 0) == ("lab-wrong" not in run["varied"]["sampler"]), job.stderr
    one = turnpath.run_of(runs[0]["key"], recipe, **given).report
    assert one["varied"] == runs[0]["varied"] and one["control_points"] > 1000
    states = [run["state"] for run in turnpath.plan(recipe, **given)]
    assert states == ["done", "done", "done", "failed"]
    merged = turnpath.merge(recipe, **given)
    assert merged.reused == 3 and "ValueError: not today" in merged[3]["reason"]
    assert {file.name for file in merged.files} >= {"ablation.json", "ablation.csv"}
    again = turnpath.ablate(recipe, **given)
    assert again.reused == 3 and again[:3] == merged[:3]
    with pytest.raises(turnpath.RecipeError, match="no run with the key"):
        turnpath.run_of("0" * 64, recipe, **given)


def test_a_run_that_is_not_made_yet_is_a_row_that_says_so(lab, tmp_path, monkeypatch):
    monkeypatch.syspath_prepend(str(tmp_path))
    monkeypatch.delitem(sys.modules, "lab_strategies", raising=False)
    import lab_strategies

    given = {"strategies": [lab_strategies], "folder": tmp_path / "out"}
    merged = turnpath.merge(tmp_path / "part.toml", **given)
    assert merged.reused == 0 and all(row["reason"] and row["points"] is None for row in merged)


def test_the_program_says_which_runs_have_no_record(installed_lab, tmp_path, part):
    text = LAB + "\n\nrng = np.random.default_rng(1)\n\n\n@turnpath.sampler\ndef lab_random(path, block):\n"
    text += "    return lab_even(path, block, 60 + rng.integers(1))\n"
    (tmp_path / "lab_strategies.py").write_text(text)
    part["ablation"] = {"sampler": [{"use": "lab-random"}]}
    (tmp_path / "part.toml").write_text(tomli_w.dumps(part))
    program = ["-m", "turnpath", "ablate", "part.toml", "-o", "out"]
    ran = called(installed_lab, tmp_path, *program)
    assert ran.returncode == 0, ran.stderr
    words = " ".join(ran.stdout.split())
    assert "1 run has no record, because of the sampler lab-random: it takes `rng`" in words, words
    planned = called(installed_lab, tmp_path, *program, "--plan")
    assert planned.returncode == 2 and "sampler lab-random" in planned.stderr
