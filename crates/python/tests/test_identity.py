"""What tells a strategy from another of its name: records of one are never those of another."""

import functools
import hashlib
import random
import typing

import numpy as np
import pytest

import turnpath


def turns(path, block, count):
    return np.concatenate([turnpath.subdivide(*turn, count) for turn in block.turns()])


def with_default(n):
    @turnpath.sampler(name="made")
    def made(path, block, count: int = n):
        return turns(path, block, count)

    return made


def with_option(overlap):
    @turnpath.velocity(name="made", overlap=overlap)
    def made(nodes):
        return nodes["c_rate"], nodes["x_rate"], nodes["z_rate"]

    return made


def holding(value):
    @turnpath.sampler(name="made")
    def made(path, block):
        return value

    return made


def calling(n):
    def helper(path, block, count=n, *, more=0):
        return turns(path, block, count + more)

    return holding(helper)


def wrapped(n):
    def factor(function):
        @functools.wraps(function)
        def wrapper(path, block):
            return function(path, block, n)

        return wrapper

    return holding(factor(turns))


class Spline:
    order = 3

    def __init__(self, knots):
        self.knots = np.array(knots, dtype=float)

    def at(self, x):
        return x


def with_method(knots):
    return holding(Spline(knots).at)


def with_class(n):
    class Local:
        count = n

    return holding(Local)


def with_inner_global(n):
    # The name is used in an inner function alone.
    space = {"np": np, "turnpath": turnpath, "count": n}
    text = (
        "@turnpath.sampler(name='made')\n"
        "def made(path, block):\n"
        "    return [(lambda: count)() for _ in (1, 2)]\n"
    )
    exec(text, space)
    return space["made"]


def with_attribute(n):
    made = holding(0)
    made.function.count = n
    return made


def with_changed_attribute(n):
    def made(path, block):
        return made.count

    made.count = 0
    strategy = turnpath.sampler(made)
    strategy.count = n
    return strategy


def with_keyword(n):
    @turnpath.sampler(name="made")
    def made(path, block, *, count: int = n):
        return turns(path, block, count)

    return made


LAMBDAS = [lambda x: x + 1, lambda x: x + 2]  # of one line


@pytest.mark.parametrize(
    ("make", "one", "other"),
    [
        (with_default, 40, 80),
        (with_keyword, 40, 80),
        (with_option, 1, 3),
        (holding, 1, 1.0),
        (holding, 0.0, -0.0),
        (holding, "1", 1),
        (holding, [1, [2, 3]], [[1, 2], 3]),
        (holding, {"a": 1}, {"a": 2}),
        (holding, np.array([1.0, 2.0]), np.array([1.0, 3.0])),
        (holding, np.zeros((2, 3)), np.zeros((3, 2))),
        (holding, functools.partial(pow, 2), functools.partial(pow, 3)),
        (holding, functools.partial(int, base=2), functools.partial(int, base=3)),
        (holding, LAMBDAS[0], LAMBDAS[1]),
        (holding, np.sin, np.cos),
        (calling, 40, 80),
        (wrapped, 40, 80),
        (holding, Spline([1.0]), Spline([2.0])),
        (with_method, [1.0], [2.0]),
        (with_class, 1, 2),
        (with_inner_global, 1, 2),
        (with_attribute, 1, 2),
        (with_changed_attribute, 1, 2),
    ],
)
def test_another_value_is_another_identity_and_the_same_value_is_not(make, one, other):
    first, second = make(one).identity(), make(other).identity()
    assert first[0] and second[0], (first, second)
    assert first != second
    assert make(one).identity() == first


@pytest.mark.parametrize(
    "value",
    [
        random.Random(1),
        np.random.default_rng(1),
        np.array([{}], dtype=object),
        np.ma.array([1.0], mask=[True]),
        iter([1]),
        [1, object()],
    ],
)
def test_what_has_no_exact_hash_is_named(value):
    found, why = holding({"inner": value}).identity()
    assert found is None and "`value`" in why, why


def test_a_default_of_a_factory_is_another_run(part, tmp_path):
    part["part"]["aperture"] = "3 mm"
    own = {**part, "sampler": {"use": "made"}}
    lists = {"tolerance.residual": ["100 nm"]}

    def points(n):
        rows = turnpath.ablate(own, lists, strategies=[with_default(n)], folder=tmp_path)
        return rows.reused, [row["points"] for row in rows]

    assert points(40)[0] == 0
    reused, coarse = points(40)
    assert reused == 2
    reused, fine = points(80)
    assert reused == 0 and all(1.8 * few < many for few, many in zip(coarse, fine))


def test_a_strategy_beside_it_does_not_change_its_records(part, tmp_path):
    part["part"]["aperture"] = "3 mm"
    own = {**part, "sampler": {"use": "made"}}
    lists = {"tolerance.residual": ["100 nm"]}
    made, other = with_default(40), with_option(1)
    assert turnpath.ablate(own, lists, strategies=[made], folder=tmp_path).reused == 0
    assert turnpath.ablate(own, lists, strategies=[made, other], folder=tmp_path).reused == 2


def test_a_run_without_an_identity_is_made_each_time_and_its_row_says_why(part, tmp_path):
    part["part"]["aperture"] = "3 mm"
    source = random.Random(1)

    @turnpath.sampler
    def jittered(path, block):
        return turns(path, block, 40 + source.randrange(1))

    lists = {"sampler": [{"use": "jittered"}]}
    for reused in (0, 1):
        rows = turnpath.ablate(part, lists, strategies=[jittered], folder=tmp_path)
        assert rows.reused == reused and all(row["points"] for row in rows)
        built_in, own = rows
        assert built_in["not_recorded"] is None
        assert "sampler jittered" in own["not_recorded"] and "`source`" in own["not_recorded"]
        assert rows.report["runs"][1]["not_recorded"] == own["not_recorded"]
    assert len(list((tmp_path / "runs").iterdir())) == 1
    # A queue would know it by nothing.
    with pytest.raises(turnpath.RecipeError, match="sampler jittered"):
        turnpath.plan(part, lists, strategies=[jittered], folder=tmp_path)


def test_the_hash_in_the_summary_is_that_of_the_file(part):
    part["sampler"] = {"use": "made"}
    report = turnpath.run(part, strategies=[with_default(40), with_option(1)]).report
    with open(__file__, "rb") as file:
        wanted = hashlib.sha256(file.read()).hexdigest()
    assert [(one["file"], one["sha256"]) for one in report["plugins"] if one["file"]] == [(__file__, wanted)]


# What a fitted surface is made for.


@turnpath.surface
def wavy(x, y):
    """cos 3x, with a branch that no formula has."""
    return 1e-3 * np.where(x < 9, np.cos(3 * x), 0)


@pytest.mark.filterwarnings("ignore::turnpath.TraceWarning")
def test_a_fitted_surface_is_made_for_the_part_of_each_variant(part, tmp_path):
    part["surface"] = {"use": "wavy"}
    part["feed"]["feed"] = "60 um/rev"
    small, large = {**part, "part": {"aperture": "3 mm"}}, {**part, "part": {"aperture": "8 mm"}}
    vary = {"part.aperture": ["8 mm"]}, {"part.aperture": ["3 mm"]}
    beside = turnpath.ablate(small, vary[0], strategies=[wavy], folder=tmp_path)[1]
    alone = turnpath.ablate(large, vary[1], strategies=[wavy])
    again = turnpath.ablate(large, vary[1], strategies=[wavy], folder=tmp_path)
    assert again.reused == 2
    for column in ("error_max_nm", "z_acceleration_rms_mm_per_s2"):
        names = [name for name in beside if name == column]
        assert names, sorted(beside)
        assert beside[column] == alone[0][column] == again[0][column]
    remarks = [one["kind"] for run in again.report["runs"] for one in run["remarks"]]
    assert "beyond_data" not in remarks and "fitted_surface" in remarks


@turnpath.surface
def ripples(x, y):
    """Waves that the first grid resolves to a nanometre or so."""
    return 1e-5 * np.where(x < 9, np.cos(25 * x), 0)


@pytest.mark.filterwarnings("ignore::turnpath.TraceWarning")
def test_a_fitted_surface_holds_the_tolerance_of_each_variant(part):
    part["surface"] = {"use": "ripples"}
    part["part"]["aperture"] = "3 mm"
    rows = turnpath.ablate(part, {"tolerance.interpolation": ["1 nm"]}, strategies=[ripples])
    errors = [
        next(one["error_nm"] for one in run["remarks"] if one["kind"] == "fitted_surface")
        for run in rows.report["runs"]
    ]
    # A twentieth of 100 nm and of 1 nm.
    assert 0.05 < errors[0] < 5.0 and errors[1] < 0.05, errors


# Bytes that differ between machines.


def kinds(part, surface, *strategies):
    report = turnpath.run({**part, "surface": surface}, strategies=strategies).report
    return [one["kind"] for one in report["remarks"]]


@pytest.mark.filterwarnings("ignore::turnpath.TraceWarning")
def test_the_parameters_of_the_recipe_decide_whether_bytes_may_differ(part):
    @turnpath.surface
    def modes(x, y, mode: typing.Literal["formula", "table"] = "formula", p: float = 0.3):
        if mode == "formula":
            return 1e-3 * np.cos(p * x)
        return np.where(x < 1e9, 1e-3 * np.cos(p * x), 0)

    assert "not_byte_exact" not in kinds(part, {"use": "modes"}, modes)
    assert "not_byte_exact" in kinds(part, {"use": "modes", "mode": "table"}, modes)


@pytest.mark.parametrize(
    ("function", "exact"),
    [
        (lambda x, y, p=1.3: 1e-4 * (x * x + 90) ** p, True),
        (lambda x, y, p=1.3: 1e-4 * (x * x + 90) ** (0.5 * p), True),
        (lambda x, y, p=1.3: 1e-4 * (x * x + 90) ** np.exp(-p), False),
        (lambda x, y, p=1.3: 1e-3 * x * np.exp(p), True),
        (lambda x, y, p=1.3: 1e-3 * x * (1.0 if np.sin(p) > 0.5 else 2.0), False),
        (lambda x, y, p=1.3: 1e-3 * x * (1.0 if p > 0.5 else 2.0), True),
        (lambda x, y, p=1.3: 1e-3 * x * float(p), False),
    ],
)
def test_a_number_that_numpy_worked_out_makes_a_formula_differ(part, function, exact):
    function.__name__ = "powered"
    function.__annotations__ = {"p": float}
    found = kinds(part, {"use": "powered"}, turnpath.surface(function))
    assert ("not_byte_exact" not in found) == exact
