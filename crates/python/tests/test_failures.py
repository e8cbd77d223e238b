"""What a strategy that is wrong raises, with its cause, and what stays behind."""

import contextlib
import gc
import os
import threading
import time
import typing

import numpy as np
import pytest

import turnpath


def sampler(function):
    return turnpath.sampler(function, name="wrong")


def failure(part, strategy, **options):
    part[strategy.slot] = {"use": strategy.name}
    with pytest.raises(turnpath.StrategyError) as caught:
        turnpath.run(part, strategies=[strategy], **options)
    return caught.value


class Mute(Exception):
    def __str__(self):
        raise RuntimeError("no text")


@pytest.mark.parametrize(
    "error",
    [
        ValueError("first line\nsecond line"),
        ValueError("a\x1b[31mred\tb\x00c"),
        ValueError("half of a pair: \udcff"),
        ValueError(""),
        ValueError("word " * 200),
        Mute(),
        KeyError("missing"),
        SystemExit(3),
    ],
)
def test_whatever_a_strategy_raises_is_the_cause(part, error):
    @sampler
    def wrong(path, block):
        raise error

    found = failure(part, wrong)
    assert found.__cause__ is error and found.strategy == "sampler wrong"
    assert found.source.startswith("test_failures.py, line")
    assert type(error).__name__ in str(found)


def test_an_error_without_a_text_has_its_name_alone(part):
    @sampler
    def wrong(path, block):
        raise ValueError

    text = " ".join(str(failure(part, wrong)).split())
    assert "raised ValueError (test_failures.py, line" in text, text


def test_the_compensator_is_blamed_for_its_own_error(part):
    """A sampler hears of it as an error of its question."""
    cause = ZeroDivisionError("in the compensator")

    @turnpath.compensator
    def broken(cut, theta, rho):
        raise cause

    part["compensator"] = {"use": "broken"}
    found = failure(part, broken)
    assert found.strategy == "compensator broken" and found.__cause__ is cause


@pytest.mark.parametrize(
    ("answer", "words"),
    [
        (np.array([0.1 + 1j, 0.2]), "complex128"),
        (np.array([True, False]), "bool"),
        ([True, False], "bool"),
        (["0.1", "0.2"], "no column of numbers"),
        (np.array([0.1, None]), "object"),
        (np.zeros((3, 2)), "2 dimensions"),
        (None, "NoneType"),
    ],
)
def test_a_column_that_is_not_of_real_numbers_is_refused(part, answer, words):
    text = str(failure(part, sampler(lambda path, block: answer)))
    assert words in " ".join(text.split()), text


def test_rows_that_are_not_of_real_numbers_are_refused(part):
    law = turnpath.feed(lambda setup: np.full((1, 7), 1 + 1j), name="wrong")
    assert "complex128" in str(failure(part, law))


# Declarations.


@pytest.mark.parametrize(
    ("annotation", "default", "words"),
    [
        (typing.Annotated[turnpath.Length, turnpath.Limits(positive=True)], "-1 mm", "limits"),
        (typing.Annotated[turnpath.Length | None, turnpath.Limits(positive=True)], "0 mm", "limits"),
        (typing.Annotated[turnpath.Length, turnpath.Limits(max="1 mm")], "2 mm", "limits"),
        (typing.Annotated[float, turnpath.Limits(nonzero=True)], 0.0, "limits"),
        (float, float("nan"), "limits"),
        (int, -2, "limits"),
        (int, 2.5, "not a count"),
        (int, True, "not a count"),
        (bool, 1, "not a flag"),
        (str, 1, "not a text"),
        (float, "1", "not a number"),
        (typing.Literal[1, 2], 1, "no texts"),
        (typing.Literal["a", "b"], "c", "not one of a, b"),
        (typing.Annotated[float, turnpath.Limits(min="5 um")], 1.0, "no number"),
        (typing.Annotated[turnpath.Length, turnpath.Limits(min=5.0)], "1 mm", "texts"),
        (typing.Annotated[str, turnpath.Limits(min=5.0)], "x", "no limits"),
        (turnpath.Length, "1 mmm", "mmm"),
    ],
)
def test_a_parameter_that_nobody_could_use_is_refused_where_it_is_declared(annotation, default, words):
    def wrong(path, block, k=default):
        return []

    wrong.__annotations__ = {"k": annotation}
    with pytest.raises((TypeError, ValueError)) as caught:
        turnpath.sampler(wrong)
    assert words in str(caught.value) and "wrong: the parameter `k`" in str(caught.value)


@pytest.mark.parametrize(
    ("slot", "options"),
    [
        (turnpath.velocity, {"overlap": -1}),
        (turnpath.velocity, {"overlap": 2.5}),
        (turnpath.velocity, {"segments": "cubi"}),
        (turnpath.compensator, {"radial": "center"}),
        (turnpath.surface, {"extent": "6"}),
        (turnpath.surface, {"extent": "-6 mm"}),
        (turnpath.surface, {"fit_error": "1 deg"}),
        (turnpath.sampler, {"plan": 3}),
    ],
)
def test_an_option_that_means_nothing_is_refused_with_its_strategy(slot, options):
    key = next(iter(options))
    with pytest.raises(ValueError, match=f"odd: the option `{key}`"):
        slot(lambda a, b, c: a, name="odd", **options)


# Strategies that do not come back.


def threads_of_this_process():
    return len(os.listdir("/proc/self/task"))


def test_a_surface_that_loops_is_named_within_its_time(part):
    @turnpath.surface
    def loops(x, y):
        while True:
            pass

    # It is not called where a recipe does not choose it.
    assert turnpath.run(dict(part), strategies=[loops], time_limit=5).holds
    assert any(one["name"] == "loops" for one in turnpath.strategies([loops]))
    begun = time.monotonic()
    found = failure(part, loops, time_limit=0.5)
    assert found.strategy == "surface loops" and time.monotonic() - begun < 10
    assert "did not come back within 0.5 s" in " ".join(str(found).split())


@pytest.mark.skipif(not os.path.isdir("/proc/self/task"), reason="this system has no /proc")
def test_calls_that_stay_behind_are_bounded_and_their_threads_end_with_them(part, monkeypatch):
    session = turnpath._session
    monkeypatch.setattr(session, "GRACE", 0.1)
    monkeypatch.setattr(session, "MOST_LEFT", 2)
    # Those of other tests do not count.
    monkeypatch.setattr(session, "_left", [])
    gate = threading.Event()

    @turnpath.sampler
    def stuck(path, block):
        gate.wait(60)
        return np.linspace(block.start, block.end, 2000, endpoint=False)

    before = threads_of_this_process()
    for _ in range(2):
        assert failure(part, stuck, time_limit=0.1, threads=3).strategy == "sampler stuck"
    # Each keeps its pool and the thread that waits for it.
    assert threads_of_this_process() <= before + 2 * 4
    for _ in range(20):
        with pytest.raises(turnpath.StrategyError, match="2 earlier calls"):
            turnpath.run(part, strategies=[stuck], time_limit=0.1, threads=3)
    assert threads_of_this_process() <= before + 2 * 4
    gate.set()
    deadline = time.monotonic() + 20
    while threads_of_this_process() > before and time.monotonic() < deadline:
        time.sleep(0.05)
    gc.collect()
    assert threads_of_this_process() <= before
    part["sampler"] = {"use": "equal-angle", "step": "6 deg"}
    assert turnpath.run(part).holds


def test_only_a_call_that_is_late_is_named(part, monkeypatch):
    session = turnpath._session
    monkeypatch.setattr(session, "GRACE", 0.3)
    monkeypatch.setattr(session, "_left", [])
    gate = threading.Event()

    class Late:
        slot, name = "sampler", "late"

    class Early:
        slot, name = "sampler", "early"

    one = session.Session(time_limit=0.2)

    def command():
        def waits():
            with contextlib.suppress(Exception):
                one.guard(Late, gate.wait)(30)

        late = threading.Thread(target=waits)
        late.start()
        while not gate.is_set():
            one.guard(Early, time.sleep)(0.01)
        late.join()

    with pytest.raises(turnpath.StrategyError) as caught:
        one.work(command)
    gate.set()
    assert "`late`" in str(caught.value) and "`early`" not in str(caught.value)


class Enough(Exception):
    pass


def stop(stage, done, total):
    raise Enough


class Patient:
    slot, name = "sampler", "patient"


def endless():
    while True:
        time.sleep(0.01)


def one_after_the_other(guard):
    with contextlib.suppress(Exception):
        guard(Patient, endless)()
    guard(Patient, endless)()


def one_within_the_other(guard):
    def asks():
        with contextlib.suppress(Exception):
            guard(Patient, endless)()
        endless()

    guard(Patient, asks)()


@pytest.mark.parametrize("calls", [one_after_the_other, one_within_the_other])
def test_every_call_hears_that_the_work_was_stopped(calls):
    one = turnpath._session.Session(time_limit=3)
    with pytest.raises(Enough):
        one.work(lambda: calls(one.guard), stop)
    assert [type(failure.error).__name__ for failure in one._failures] == ["Interruption"] * 2
