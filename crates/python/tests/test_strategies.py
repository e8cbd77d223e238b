"""Strategies in Python: what they give, and what a wrong one raises."""

import inspect
import threading
import time
import typing

import numpy as np
import pytest

import turnpath


@turnpath.surface
def coma(x, y, a: turnpath.Length, radius: turnpath.Length):
    """Zernike coma, Noll 7: sqrt(8)·(3r³ − 2r)·sin θ."""
    u, v = x / radius, y / radius
    return a * np.sqrt(8) * (3 * (u * u + v * v) - 2) * v


@turnpath.sampler
def even_arc(path, block, spacing: turnpath.Length = "0.2 mm"):
    """As many even steps on each turn as its arc needs."""
    nodes = []
    for start, end in block.turns():
        rho = np.abs(path.radius_at([start, end])).max()
        steps = max(2 * np.pi * rho / spacing, 36)
        nodes.append(turnpath.subdivide(start, end, steps))
    return np.concatenate(nodes)


def of_coma(part, surface):
    part["surface"] = surface
    part["sampler"] = {"use": "equal-angle", "step": "10 deg"}
    return part


def test_traced_coma_is_the_built_in_one(part):
    own = of_coma(part, {"use": "coma", "a": "1.2 um", "radius": "2.5 mm"})
    traced = turnpath.run(own, strategies=[coma])
    native = of_coma(
        part,
        {
            "use": "zernike",
            "indexing": "noll",
            "normalization_radius": "2.5 mm",
            "coefficients": {"7": "1.2 um"},
        },
    )
    built_in = turnpath.run(native)
    assert len(traced.toolpath.t) == len(built_in.toolpath.t)
    assert np.abs(traced.toolpath.z - built_in.toolpath.z).max() < 1e-12
    assert np.abs(traced.toolpath.x - built_in.toolpath.x).max() < 1e-12
    assert np.array_equal(traced.toolpath.c, built_in.toolpath.c)
    assert not any(remark["kind"] == "not_byte_exact" for remark in traced.report["remarks"])
    source = traced.report["plugins"][0]
    assert source["file"] == __file__ and len(source["sha256"]) == 64


def test_a_sampler_is_a_row_of_an_ablation(part, tmp_path):
    lists = {"sampler": [{"use": "equal-angle", "step": "6 deg"}, {"use": "even-arc"}]}
    rows = turnpath.ablate(part, lists, strategies=[even_arc], folder=tmp_path)
    assert [row["sampler"] for row in rows] == ["equal-angle", "even-arc"]
    assert rows[1]["reason"] is None and rows[1]["points"] > 1000
    assert rows[1]["points"] != rows[0]["points"]
    # Another source has another key, and a sampler that is built in has not.
    step = 0.3

    @turnpath.sampler(name="even-arc")
    def other(path, block, spacing: turnpath.Length = "0.2 mm"):
        return even_arc(path, block, spacing * step)

    again = turnpath.ablate(part, lists, strategies=[other], folder=tmp_path)
    assert again.reused == 1
    step = 0.2
    assert turnpath.ablate(part, lists, strategies=[other], folder=tmp_path).reused == 1
    assert turnpath.ablate(part, lists, strategies=[other], folder=tmp_path).reused == 2


def test_a_run_with_an_untraced_strategy_is_marked(part):
    part["sampler"] = {"use": "even-arc", "spacing": "0.1 mm"}
    report = turnpath.run(part, strategies=[even_arc]).report
    marks = [one for one in report["remarks"] if one["kind"] == "not_byte_exact"]
    assert [mark["strategies"] for mark in marks] == [["sampler even-arc"]]


def the_whole_path(path, count):
    """The largest ρ, and how often it was looked for."""
    the_whole_path.calls += 1
    return np.abs(path.radius_at(np.linspace(0, path.end, 1000))).max(), path.end


@turnpath.sampler(plan=the_whole_path)
def planned(path, block, plan, count: int = 60):
    """As many points on each turn as its part of the largest radius."""
    largest, end = plan
    turns = [turnpath.subdivide(*turn, count) for turn in block.turns()]
    assert path.radius_at([block.start])[0] <= largest + 1e-9 and block.end <= end
    return np.concatenate(turns)


def test_a_sampler_may_look_at_the_whole_path_once(part):
    the_whole_path.calls = 0
    own = turnpath.run(dict(part, sampler={"use": "planned"}), strategies=[planned])
    assert the_whole_path.calls == 1
    native = turnpath.run(dict(part, sampler={"use": "equal-angle", "step": "6 deg"}))
    assert len(own.toolpath.t) == len(native.toolpath.t)


# What a wrong strategy raises.


@turnpath.sampler
def raises(path, block):
    return 1 / (block.start - block.start)


@turnpath.sampler
def no_numbers(path, block):
    nodes = np.linspace(block.start, block.end, 1000, endpoint=False)
    nodes[500] = np.nan
    return nodes


@turnpath.compensator
def short(cut, theta, rho):
    return rho, rho, rho[:-1]


@turnpath.sampler
def endless(path, block):
    while True:
        pass


@turnpath.sampler
def asleep(path, block):
    time.sleep(3600)


@pytest.mark.parametrize(
    ("strategy", "words", "source"),
    [
        (raises, ["`raises`", "ZeroDivisionError", "float division by zero"], "line"),
        (no_numbers, ["`no-numbers`", "node 500 is NaN"], None),
        (short, ["`short`", "numbers as foot"], None),
    ],
)
def test_a_wrong_strategy_is_named_with_its_place(part, strategy, words, source):
    part[strategy.slot] = {"use": strategy.name}
    with pytest.raises(turnpath.StrategyError) as caught:
        turnpath.run(part, strategies=[strategy])
    error = caught.value
    text = " ".join(str(error).split())
    for word in words:
        assert word in text, text
    # The place in the recipe that chooses it.
    assert error.place is not None and strategy.name in error.place.text
    assert error.strategy == f"{strategy.slot} {strategy.name}"
    if source is not None:
        assert error.source.startswith("test_strategies.py, line")
        assert isinstance(error.__cause__, ZeroDivisionError)


def test_a_strategy_that_loops_for_ever_is_named_and_ends(part):
    part["sampler"] = {"use": "endless"}
    threads = threading.active_count()
    with pytest.raises(turnpath.StrategyError, match="endless") as caught:
        turnpath.run(part, strategies=[endless], time_limit=0.5, threads=2)
    assert "did not come back within 0.5 s" in " ".join(str(caught.value).split())
    assert caught.value.strategy == "sampler endless" and "line" in caught.value.source
    assert threading.active_count() == threads


def test_a_strategy_in_foreign_code_is_named_too(part, monkeypatch):
    monkeypatch.setattr(turnpath._session, "GRACE", 0.5)
    part["sampler"] = {"use": "asleep"}
    with pytest.raises(turnpath.StrategyError, match="code that is not Python's") as caught:
        turnpath.run(part, strategies=[asleep], time_limit=0.3, threads=1)
    assert caught.value.strategy == "sampler asleep"


# Locks and threads.


@turnpath.compensator
def along_z(cut, theta, rho):
    """The nose above the point that it touches, along its normal."""
    z, zx, zy = cut.surface.gradient(rho * np.cos(theta), rho * np.sin(theta))
    slope = zx * np.cos(theta) + zy * np.sin(theta)
    length = np.hypot(1, slope)
    radius = cut.tool.nose_radius
    return rho - radius * slope / length, z + radius / length, rho


def test_a_compensator_that_is_asked_by_a_sampler_on_many_threads(part):
    seen = []

    @turnpath.sampler
    def asking(path, block):
        thread = threading.get_ident()
        nodes = even_arc(path, block, 0.2)
        # The locus asks the compensator, which asks the surface: three changes of the lock.
        x, z = path.series_at(nodes)
        centre = path.locus.centre(2 * np.pi * nodes, path.radius_at(nodes))
        assert x.shape == z.shape == (len(nodes), 5)
        assert np.abs(x[:, 0] - centre[0]).max() < 1e-9
        seen.append((thread, threading.get_ident(), path))
        return nodes

    own = dict(part, sampler={"use": "asking"}, compensator={"use": "along-z"})
    own["feed"] = {"use": "constant", "feed": "40 um/rev"}
    result = turnpath.run(own, strategies=[asking, along_z], threads=4)
    assert len(result.toolpath.t) > 1000
    assert all(before == after for before, after, _ in seen)
    # What was lent is asked for in vain afterwards.
    path = seen[0][2]
    with pytest.raises(RuntimeError, match="has ended"):
        path.locus.heights([0.0], [0.0])
    assert path.radius_at([0.0])[0] > 2


def test_a_compensator_in_python_places_the_nose_like_the_built_in_one(part):
    own = dict(part, compensator={"use": "along-z"}, feed={"use": "constant", "feed": "40 um/rev"})
    mine = turnpath.run(own, strategies=[along_z])
    native = turnpath.run(dict(own, compensator={"use": "normal"}))
    assert np.abs(mine.toolpath.z - native.toolpath.z).max() < 1e-9


def test_two_runs_at_a_time_give_what_each_gives_alone(part):
    own = [dict(part, sampler={"use": "even-arc", "spacing": size}) for size in ("0.1 mm", "0.3 mm")]
    alone = [turnpath.run(one, strategies=[even_arc]).toolpath for one in own]
    found = [None, None]

    def run(number):
        found[number] = turnpath.run(own[number], strategies=[even_arc], threads=3).toolpath

    threads = [threading.Thread(target=run, args=(number,)) for number in range(2)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    for one, other in zip(alone, found):
        assert all(np.array_equal(a, b) for a, b in zip(one, other))


# The other slots.


@turnpath.feed
def steady(setup, feed: turnpath.Feed = "20 um/rev"):
    """The same feed from the rim to the centre."""
    inner, outer = setup.task.range
    turns = (outer - inner) / feed
    return [[turns, outer, -feed, 0, 0, 0, 0]]


@turnpath.velocity(exact_rates=True)
def exact(nodes):
    return nodes["c_rate"], nodes["x_rate"], nodes["z_rate"]


@turnpath.spindle
def half_speed(path, speed, factors, part: float = 0.5):
    return [[path.end + 1, 0, 2 * np.pi / (speed * part), 0, 0, 0, 0]]


def test_feed_solver_and_spindle_of_python_are_those_of_the_library(part):
    native = turnpath.run(part)
    for table, own in [("feed", {"use": "steady"}), ("velocity", {"use": "exact"})]:
        mine = turnpath.run(dict(part, **{table: own}), strategies=[steady, exact])
        assert len(mine.toolpath.t) == len(native.toolpath.t)
        for one, other in zip(mine.toolpath, native.toolpath):
            assert np.abs(one - other).max() <= 1e-9 * np.abs(other).max()


def test_a_spindle_of_python_turns_at_its_speed(part):
    part["spindle"] = {"use": "half-speed", "speed": "500 rpm"}
    path = turnpath.run(part, strategies=[half_speed]).toolpath
    cut = path.section == 1
    assert np.allclose(path.vc[cut], 250 * 2 * np.pi / 60)


# Surfaces that are no formulas.


@turnpath.surface
def kinked(x, y, depth: turnpath.Length = "2 um"):
    """A shallow dish that is written with a branch."""
    z = np.where(x * x + y * y > 0, np.cos(0.3 * x) * np.cos(0.2 * y), 1.0)
    return depth * z


def test_an_untraced_surface_says_why_and_has_its_error_told(part):
    part["surface"] = {"use": "kinked"}
    with pytest.warns(turnpath.TraceWarning, match="it compares x or y") as caught:
        result = turnpath.run(part, strategies=[kinked])
    lines, first = inspect.getsourcelines(kinked.function)
    assert (caught[0].filename, caught[0].lineno) == (__file__, first)
    fitted = [one for one in result.report["remarks"] if one["kind"] == "fitted_surface"]
    assert len(fitted) == 1 and 0 < fitted[0]["error_nm"] < 0.05 * 100
    assert "it compares x or y" in result.notes[0]
    with pytest.raises(turnpath.TraceError, match="it compares"):
        kinked.trace()

    @turnpath.surface
    def smooth(x, y):
        return 2e-3 * np.cos(0.3 * x) * np.cos(0.2 * y)

    native = turnpath.run(dict(part, surface={"use": "smooth"}), strategies=[smooth])
    assert native.notes == ()
    assert np.abs(native.toolpath.z - result.toolpath.z).max() < 5e-6


def test_a_spline_is_asked_once_a_grid_and_never_in_loops(part):
    calls = []

    @turnpath.surface
    def counted(x, y):
        calls.append(np.size(x))
        return 2e-3 * np.maximum(np.round(0.0 * x), np.cos(0.3 * x))

    part["surface"] = {"use": "counted"}
    with pytest.warns(turnpath.TraceWarning, match="numpy"):
        turnpath.run(part, strategies=[counted])
    # Once as a trace where it is declared and once where it is made, then two batches a grid.
    batches = [size for size in calls if size > 1]
    assert 2 <= len(batches) <= 10 and min(batches) >= 64 * 64


@pytest.mark.parametrize(
    ("function", "words"),
    [
        (lambda x, y: x if x > 0 else y, "it compares x or y"),
        (lambda x, y: __import__("math").sin(x), "write numpy.sin"),
        (lambda x, y: np.where(x, x, y), "no numpy.where"),
        (lambda x, y: np.floor(x), "no numpy.floor"),
        (lambda x, y: x * np.array([1.0, 2.0]), "uses an array"),
        (lambda x, y: x @ y, "raises TypeError"),
        (lambda x, y: "3 mm", "uses str"),
    ],
)
def test_what_no_formula_does_has_its_reason(function, words):
    function.__name__ = "odd"
    with pytest.raises(turnpath.TraceError, match=words):
        turnpath.surface(function).trace()


def test_parameters_may_branch_and_have_every_kind(part):
    seen = {}

    @turnpath.surface
    def dish(
        x,
        y,
        depth: turnpath.Length,
        sense: typing.Literal["up", "down"] = "down",
        waves: int = 3,
        tilted: bool = False,
        tilt: turnpath.Angle | None = None,
        factor: typing.Annotated[float, turnpath.Limits(min=0.5, max=2.0)] = 1.0,
    ):
        seen.update(sense=sense, waves=waves, tilted=tilted, tilt=tilt)
        sign = 1.0 if sense == "up" else -1.0
        z = sum(np.cos(0.1 * k * x) for k in range(waves))
        return sign * depth * z * (factor if factor > 1 else 1.0)

    part["surface"] = {"use": "dish", "depth": "1 um", "waves": 2}
    result = turnpath.run(part, strategies=[dish])
    assert result.notes == () and seen == {
        "sense": "down",
        "waves": 2,
        "tilted": False,
        "tilt": None,
    }
    part["surface"]["factor"] = 3.0
    with pytest.raises(turnpath.RecipeError, match="factor"):
        turnpath.run(part, strategies=[dish])
    part["surface"] = {"use": "dish", "depth": "1 deg"}
    with pytest.raises(turnpath.RecipeError) as caught:
        turnpath.run(part, strategies=[dish])
    assert caught.value.place.text.strip('"') == "1 deg"


def test_a_default_without_a_unit_and_a_host_key_are_refused(part):
    with pytest.raises(TypeError, match="needs a unit"):

        @turnpath.sampler
        def bare(path, block, pitch: turnpath.Length = 1.0):
            return []

    @turnpath.sampler
    def greedy(path, block, speed: float = 1.0):
        return []

    with pytest.raises(turnpath.Error, match="speed"):
        turnpath.run(part, strategies=[greedy])


def test_a_piece_between_two_states_has_them():
    piece = turnpath.between([0.0, 0.0, 0.0], [1.0, 0.0, 0.0], 1.0)
    assert np.array_equal(piece, [1, 0, 0, 0, 10, -15, 6])
    start, end, length = [2.0, -0.3, 0.7], [1.0, 0.2, -0.4], 3.5
    polynomial = np.polynomial.Polynomial(turnpath.between(start, end, length)[1:])
    for order, (first, last) in enumerate(zip(start, end)):
        derivative = polynomial.deriv(order) if order else polynomial
        assert derivative(0.0) == pytest.approx(first)
        assert derivative(length) == pytest.approx(last)
