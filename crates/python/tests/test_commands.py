"""The commands give what the library gives, and say what is wrong and where."""

import json
import os
import signal
import subprocess
import sys
import textwrap
import threading
import time

import numpy as np
import pytest

import turnpath
from turnpath import _turnpath
from turnpath._recipe import as_recipe
from turnpath._session import Session
from turnpath._strategies import sources


def test_a_run_gives_report_verdict_and_columns(part):
    result = turnpath.run(part)
    path = result.toolpath
    assert result.holds and result.verdict["interpolation"] is True
    assert result.report["rows"] == len(path.t) == len(path.vz)
    assert (np.diff(path.t) > 0).all() and path.c.dtype == np.float64
    assert set(path.section) == {0, 1, 2}
    # The cut goes from the rim inward; C is unwrapped.
    cut = path.section == 1
    assert path.x[cut][0] > 2.4 and abs(path.x[cut][-1]) < 0.1
    assert path.c[cut][-1] > 100 * 2 * np.pi


def test_a_dict_a_text_and_a_file_are_one_recipe(part, tmp_path):
    import tomli_w

    file = tmp_path / "part.toml"
    file.write_text(tomli_w.dumps(part))
    of_dict, of_file = turnpath.run(part), turnpath.run(file)
    of_text = turnpath.run(turnpath.Recipe.from_text(file.read_text()))
    for other in (of_file, of_text):
        for one, two in zip(of_dict.toolpath, other.toolpath):
            assert np.array_equal(one, two)


def test_the_bytes_do_not_depend_on_threads(part):
    one, four = turnpath.run(part, threads=1), turnpath.run(part, threads=4)
    for a, b in zip(one.toolpath, four.toolpath):
        assert np.array_equal(a, b)


def test_changes_take_the_places_of_values(part):
    changes = {"tolerance.residual": "50 nm", "feed": {"use": "constant", "feed": "7 um/rev"}}
    finer = turnpath.run(part, set=changes)
    assert finer.report["revolutions"] > 2 * turnpath.run(part).report["revolutions"]


def test_changes_of_every_kind_are_written_as_a_recipe_has_them(part):
    tomllib = pytest.importorskip("tomllib")

    written = turnpath._recipe._written
    value = {
        "use": 'a "quoted" text with a \\ and µ',
        "list": [1, 2.5, True, {"k": "1 mm", "long": "x" * 200}],
        "array": np.array([0.1, 0.2]),
        "4,0": np.float64(1e-9),
    }
    found = tomllib.loads("v = " + written(value))["v"]
    assert found == {**value, "array": [0.1, 0.2]}
    assert written("5 mm") == "5 mm"
    with pytest.raises(TypeError, match="holds no"):
        written({"k": None})


def test_a_folder_gets_the_result_and_verify_measures_it(part, tmp_path):
    part["output"] = {"data": ["csv"], "posts": ["pmac-pvt"]}
    result = turnpath.run(part, folder=tmp_path / "out")
    names = {file.name for file in result.files}
    assert {"toolpath.csv", "summary.json"} <= names and len(names) == 3
    assert json.loads((tmp_path / "out/summary.json").read_text()) == result.report
    assert len(result.toolpath.t) == result.report["rows"]
    assert len(result.programs) == 1 and b"PVT" in next(iter(result.programs.values()))
    measured = turnpath.verify(part, tmp_path / "out" / "toolpath.csv")
    assert measured.holds and measured.verdict["interpolation"] is True


def test_a_map_is_the_cusps_of_the_feed(part):
    part["tolerance"]["interpolation"] = "20 nm"
    found = turnpath.run(part).map(81)
    assert found.dz.shape == (81, 81) == (len(found.y), len(found.x))
    on_part = np.isfinite(found.dz)
    assert 0.7 < on_part.mean() < 0.8  # π/4 of the square
    # Cusps of f²/8R = 50 nm on a flat part, twice that on this one's slopes.
    assert 0 <= found.dz[on_part].min() + 20e-6 and found.dz[on_part].max() < 200e-6
    x, y = np.meshgrid(found.x, found.y)
    assert np.isnan(found.dz[np.hypot(x, y) > 2.55]).all()


def test_check_makes_no_path_and_estimates_it(part):
    report = turnpath.check(part).report["expected"]
    assert report["revolutions"] == pytest.approx(turnpath.run(part).report["revolutions"], rel=0.05)


def test_a_check_ends_at_the_part_and_hears_that_it_is_to_end(part):
    session = Session()
    native, found = as_recipe(part, None)._native(), sources((), (), session)
    _turnpath.check(native, found, session.control)
    assert session.control.progress() == ("part", 0, 0)
    session.control.cancel()
    with pytest.raises(turnpath.Cancellation):
        _turnpath.check(native, found, session.control)


def test_what_the_progress_of_a_check_raises_comes_from_the_check(part):
    class Enough(Exception):
        pass

    def stop(stage, done, total):
        assert done <= total
        raise Enough

    with pytest.raises(Enough):
        turnpath.check(part, progress=stop)


def test_a_wrong_recipe_has_its_place_and_its_help(part, tmp_path):
    file = tmp_path / "mirror.toml"
    import tomli_w

    part["tool"]["nose_radius"] = "1 mmm"
    file.write_text(tomli_w.dumps(part))
    with pytest.raises(turnpath.RecipeError) as caught:
        turnpath.run(file)
    place = caught.value.place
    line = file.read_text().splitlines()[place.line - 1]
    assert line.startswith("nose_radius") and place.file == str(file)
    assert line[place.column - 1 :].startswith(place.text) and "1 mmm" in place.text
    assert "mmm" in caught.value.title and caught.value.help


def test_a_strategy_that_is_not_there_is_the_recipes_mistake(part):
    part["sampler"] = {"use": "no-such-sampler"}
    with pytest.raises(turnpath.RecipeError, match="no-such-sampler"):
        turnpath.run(part)


def test_a_file_that_is_not_there_is_an_error_of_files(tmp_path):
    with pytest.raises(turnpath.FileError, match="missing.toml"):
        turnpath.run(tmp_path / "missing.toml")


def test_progress_is_told_and_may_end_the_run(part):
    stages = []
    part["tolerance"]["interpolation"] = "1 nm"
    part["feed"]["feed"] = "1 um/rev"
    turnpath.run(part, progress=lambda stage, done, total: stages.append((stage, done <= total)))
    assert stages and all(within for _, within in stages)

    class Enough(Exception):
        pass

    def stop(stage, done, total):
        raise Enough

    # A test of a strategy that never comes back leaves its thread.
    threads = set(threading.enumerate())
    begun = time.monotonic()
    part["feed"]["feed"] = "0.02 um/rev"
    with pytest.raises(Enough):
        turnpath.run(part, progress=stop)
    # The whole run takes minutes.
    assert time.monotonic() - begun < 30
    assert set(threading.enumerate()) <= threads


def test_an_interrupt_ends_a_run_and_leaves_no_result(part, tmp_path):
    program = textwrap.dedent(
        f"""
        import signal
        import turnpath
        # A shell starts programs in the background without it.
        signal.signal(signal.SIGINT, signal.default_int_handler)
        part = {part!r}
        part["feed"]["feed"] = "0.02 um/rev"
        print("begun", flush=True)
        try:
            turnpath.run(part, folder={str(tmp_path / "out")!r})
        except KeyboardInterrupt:
            print("interrupted")
        """
    )
    child = subprocess.Popen(
        [sys.executable, "-c", program], stdout=subprocess.PIPE, text=True, cwd=tmp_path
    )
    assert child.stdout.readline() == "begun\n"
    time.sleep(1.0)
    os.kill(child.pid, signal.SIGINT)
    try:
        rest, _ = child.communicate(timeout=60)
    finally:
        child.kill()
    assert rest == "interrupted\n" and child.returncode == 0
    assert not (tmp_path / "out" / "summary.json").exists()


@pytest.mark.parametrize("body", ["while True:\n        pass", "time.sleep(0.3)"])
def test_an_interrupt_within_a_strategy_ends_the_run_and_frees_its_folder(part, tmp_path, body):
    program = f"""
import os, signal, threading, time
import numpy as np
import turnpath

@turnpath.sampler
def patient(path, block):
    waiting.set()
    {body}
    return np.concatenate([turnpath.subdivide(a, b, 400) for a, b in block.turns()])

def interrupt():
    waiting.wait()
    time.sleep(0.2)
    os.kill(os.getpid(), signal.SIGINT)

signal.signal(signal.SIGINT, signal.default_int_handler)
waiting = threading.Event()
threading.Thread(target=interrupt, daemon=True).start()
part["sampler"] = {{"use": "patient"}}
try:
    turnpath.run(part, folder="out", strategies=[patient])
except KeyboardInterrupt:
    print("interrupted", os.path.exists("out/.turnpath"), threading.active_count())
part["sampler"] = {{"use": "equal-angle", "step": "6 deg"}}
turnpath.run(part, folder="out")
print(os.path.exists("out/summary.json"))
"""
    # The thread that interrupts may still be ending.
    said = in_a_child(program, part, tmp_path).split()
    assert said[:2] == ["interrupted", "False"] and said[2] in "12" and said[3] == "True"


def test_an_ablation_gives_rows_and_keeps_records(part, tmp_path):
    steps = [{"use": "equal-angle", "step": step} for step in ("6 deg", "3 deg")]
    rows = turnpath.ablate(part, {"sampler": steps}, folder=tmp_path)
    assert len(rows) == 2 == len(rows.report["runs"]) and rows.reused == 0
    assert [row["run"] for row in rows] == [1, 2] and not any(row["reason"] for row in rows)
    again = turnpath.ablate(part, {"sampler": steps}, folder=tmp_path)
    assert again.reused == 2 and again == rows


def in_a_child(program, part, folder):
    """What a program says in a process of its own, which gets the part."""
    text = f"part = {part!r}\n" + textwrap.dedent(program)
    ran = subprocess.run(
        [sys.executable, "-W", "ignore", "-c", text], cwd=folder, capture_output=True, text=True, timeout=120
    )
    assert ran.returncode == 0, ran.stderr
    return ran.stdout


FORKS = """
import os, threading, time
import numpy as np
import turnpath

begun, may_end = threading.Event(), threading.Event()

@turnpath.sampler
def waits(path, block):
    begun.set()
    may_end.wait(60)
    return np.linspace(block.start, block.end, 2000, endpoint=False)

part["sampler"] = {"use": "waits"}
work = threading.Thread(target=turnpath.run, args=(part,), kwargs={"strategies": [waits], "threads": 1})
work.start()
assert begun.wait(60)

def child():
    pid = os.fork()
    if pid == 0:
        part["sampler"] = {"use": "equal-angle", "step": "6 deg"}
        try:
            print("runs", turnpath.run(part).holds, flush=True)
        except RuntimeError as error:
            print(error, flush=True)
        os._exit(0)
    os.waitpid(pid, 0)

child()
may_end.set()
work.join()
child()
print(turnpath._session._active)
"""


@pytest.mark.skipif(not hasattr(os, "fork"), reason="this system has no fork")
def test_a_child_that_was_forked_during_a_run_says_spawn_and_one_afterwards_runs(part, tmp_path):
    during, after, active = in_a_child(FORKS, part, tmp_path).splitlines()
    assert "forked while turnpath worked" in during and "`spawn`" in during
    assert after == "runs True" and active == "0"


@pytest.mark.parametrize("threads", [-1, 1025, 100_000])
def test_a_count_of_threads_that_nobody_has_is_refused(part, threads):
    before = threading.active_count()
    for call in (turnpath.run, turnpath.check, turnpath.ablate):
        with pytest.raises(ValueError, match=f"threads is {threads}"):
            call(part, threads=threads)
    assert threading.active_count() == before


def test_a_map_and_a_time_limit_that_mean_nothing_are_refused(part):
    result = turnpath.run(part)
    for cells in (-1, 0, 1, 30_000):
        with pytest.raises(ValueError, match="along a side"):
            result.map(cells)
    with pytest.raises(TypeError):
        result.map(2.5)
    for limit in (0, -1, float("nan")):
        with pytest.raises(ValueError, match="time_limit"):
            turnpath.run(part, time_limit=limit)


def test_python_goes_on_while_libraries_are_read_and_loaded(part, tmp_path):
    # A file without an end, which takes its time to hash.
    library = tmp_path / "liblarge.so"
    library.write_bytes(b"\x7fELF")
    os.truncate(library, 100 << 20)
    for call in (
        lambda: turnpath.strategies(plugins=[library]),
        lambda: turnpath.run(part, plugins=[library]),
    ):
        ended, ticks = threading.Event(), []

        def count():
            while not ended.wait(0.002):
                ticks.append(time.monotonic())

        clock = threading.Thread(target=count)
        clock.start()
        begun = time.monotonic()
        with pytest.raises(turnpath.Error, match="liblarge"):
            call()
        passed = time.monotonic() - begun
        ended.set()
        clock.join()
        times = [begun, *(tick for tick in ticks if tick > begun), begun + passed]
        assert max(after - before for before, after in zip(times, times[1:])) < 0.5 * passed


def test_rows_have_the_types_of_their_figures(part):
    part["part"]["aperture"] = "3 mm"
    rows = turnpath.ablate(part, {"surface.k": ["0.05 /mm"], "refine": [True]})
    one = rows[1]
    assert type(one["run"]) is int and type(one["points"]) is int
    assert type(one["error_max_nm"]) is float and type(one["within_interpolation"]) is bool
    assert one["reason"] is None and one["not_recorded"] is None
    measured = rows.report["runs"][1]
    assert one["points"] == measured["control_points"] and one["refine"] == measured["varied"]["refine"]
    # What varies is text, whatever it looks like.
    assert all(type(row[key]) is str for row in rows for key in ("surface.k", "refine"))
