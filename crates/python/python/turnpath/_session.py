"""One command: its thread, the calls of Python that are in progress, and what went wrong in them.

The work runs on threads of its own, and the calling thread waits. So it hears Ctrl-C, tells the
progress, and ends a strategy that does not come back.
"""

from __future__ import annotations

import ctypes
import os
import threading
import time
import traceback
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any, TypeVar

from ._errors import Cancellation, Error, Interruption, StrategyError, TimeLimit
from ._turnpath import Control

Answer = TypeVar("Answer")

#: How often the calling thread looks, s. Ctrl-C is heard at once.
LOOK = 0.05
#: How long a call may take after it was told to end, s. Code that is not Python's hears nothing.
GRACE = 5.0
#: The longest single call of a strategy unless given, s.
TIME_LIMIT = 600.0

#: How many calls may stay behind whose strategy does not come back. Each keeps the threads of its
#: pool: nothing ends a thread from outside.
MOST_LEFT = 8

_PACKAGE = str(Path(__file__).parent) + os.sep
#: Guards what all calls of the process share.
_shared = threading.Lock()
_active = 0
_torn = False
_left: list[threading.Thread] = []


def _after_fork() -> None:
    """In a child that was forked: threads and their locks stayed with the parent."""
    global _torn, _active, _shared
    _torn = _torn or _active > 0
    _active = 0
    _left.clear()
    _shared = threading.Lock()


def _count_active(change: int) -> None:
    global _active
    with _shared:
        _active += change


os.register_at_fork(after_in_child=_after_fork)


class _FailureText(Exception):
    """What the native part gets of an exception: its text."""


@dataclass
class _Call:
    strategy: Any
    started: float
    told: float | None = None


@dataclass
class _Failure:
    strategy: Any
    text: str
    source: str | None
    error: BaseException


class Session:
    """What a command shares with the strategies that it calls."""

    def __init__(self, time_limit: float | None = TIME_LIMIT) -> None:
        self.control = Control()
        if time_limit is not None and not time_limit > 0:
            raise ValueError(f"time_limit is {time_limit} s; it is longer than 0 s, or None")
        self.time_limit = time_limit
        #: The strategies of Python that may be called.
        self.strategies: list[Any] = []
        #: What the caller should know of the strategies.
        self.notes: list[str] = []
        self._lock = threading.Lock()
        self._calls: dict[int, list[_Call]] = {}
        self._failures: list[_Failure] = []

    def guard(self, strategy: Any, function: Callable[..., Any]) -> Callable[..., Any]:
        """The function, whose calls are known and whose exceptions are kept."""

        def guarded(*arguments: Any) -> Any:
            thread = threading.get_ident()
            call = _Call(strategy, time.monotonic())
            try:
                with self._lock:
                    self._calls.setdefault(thread, []).append(call)
                return function(*arguments)
            except _FailureText:
                raise
            except BaseException as error:  # noqa: B902: a strategy may raise anything
                raise _FailureText(self._failed(strategy, error)) from None
            finally:
                with self._lock:
                    calls = self._calls.get(thread, [])
                    if call in calls:
                        calls.remove(call)

        return guarded

    def _failed(self, strategy: Any, error: BaseException) -> str:
        source = _source_of(error)
        place = f" ({source})" if source else ""
        if isinstance(error, TimeLimit):
            text = f"did not come back within {self.time_limit:g} s{place}"
        elif isinstance(error, Interruption):
            text = "was interrupted"
        else:
            said = _text_of(error)
            text = f"raised {type(error).__name__}" + (f": {said}" if said else "") + place
        # The native part takes no halves of surrogates.
        text = text.encode("utf-8", "backslashreplace").decode()
        with self._lock:
            self._failures.append(_Failure(strategy, text, source, error))
        return text

    def work(
        self,
        command: Callable[[], Answer],
        progress: Callable[[str, int, int], Any] | None = None,
    ) -> Answer:
        """Runs a command on a thread of its own and waits for it."""
        if _torn:
            raise RuntimeError(
                "this process was forked while turnpath worked; start it with `spawn` instead of `fork`"
            )
        _refuse_more()
        done: dict[str, Any] = {}
        ended = threading.Event()
        thread = threading.Thread(
            target=self._body, args=(command, done, ended), name="turnpath", daemon=True
        )
        thread.start()
        stop, late = self._wait(thread, ended, progress)
        if thread.is_alive() and not ended.is_set():
            self.control.cancel()
            with _shared:
                _left.append(thread)
            raise stop if stop is not None else self._stuck(late)
        if stop is not None:
            raise stop
        if "error" in done:
            raise self._explained(done["error"])
        return done["answer"]

    @staticmethod
    def _body(
        command: Callable[[], Any], done: dict[str, Any], ended: threading.Event
    ) -> None:
        _count_active(1)
        try:
            done["answer"] = command()
        except BaseException as error:  # noqa: B902: the waiting thread raises it
            done["error"] = error
        finally:
            try:
                _count_active(-1)
            finally:
                ended.set()

    def _wait(
        self,
        thread: threading.Thread,
        ended: threading.Event,
        progress: Callable[[str, int, int], Any] | None,
    ) -> tuple[BaseException | None, list[_Call]]:
        """Waits until the work has ended, or a strategy does not hear. Gives what stopped it from here,
        and the calls that do not hear; a second Ctrl-C waits no longer.

        The thread is not joined: up to Python 3.12 a Ctrl-C during `Thread.join` makes a thread that goes on say
        that it has ended."""
        stop: BaseException | None = None
        told: tuple[str, int, int] | None = None
        while thread.is_alive() and not ended.is_set():
            try:
                ended.wait(LOOK)
                if stop is None and progress is not None and self.control.progress() != told:
                    told = self.control.progress()
                    progress(*told)
            except BaseException as error:  # noqa: B902: Ctrl-C, or what `progress` raises
                if stop is not None:
                    return error, []
                stop = error
                self.control.cancel()
            if stop is not None:
                # At each look: a call may begin after the stop, and an outer call goes on after its inner one.
                self._end_calls(Interruption, lambda call: True)
            now = time.monotonic()
            if self.time_limit is not None:
                limit = self.time_limit
                self._end_calls(TimeLimit, lambda call: now - call.started > limit)
            late = self._overdue(now)
            if late:
                return stop, late
        return stop, []

    def _end_calls(self, kind: type[BaseException], which: Callable[[_Call], bool]) -> None:
        """Raises an exception in the innermost calls that are to end, each once."""
        with self._lock:
            for thread, calls in self._calls.items():
                if calls and calls[-1].told is None and which(calls[-1]):
                    calls[-1].told = time.monotonic()
                    ctypes.pythonapi.PyThreadState_SetAsyncExc(
                        ctypes.c_ulong(thread), ctypes.py_object(kind)
                    )

    def _overdue(self, now: float) -> list[_Call]:
        """The calls that did not hear that they are to end."""
        with self._lock:
            calls = [call for calls in self._calls.values() for call in calls[-1:]]
        return [call for call in calls if call.told is not None and now - call.told > GRACE]

    def _stuck(self, late: list[_Call]) -> StrategyError:
        """The error for calls that do not come back at all. Their threads stay."""
        names = dict.fromkeys(f"{call.strategy.slot} `{call.strategy.name}`" for call in late)
        error = StrategyError(
            f"the {', '.join(names)} did not come back within {self.time_limit:g} s, and does not hear "
            "that it is to end: it is in code that is not Python's"
        )
        error.strategy = f"{late[0].strategy.slot} {late[0].strategy.name}"
        return error

    def _explained(self, error: BaseException) -> BaseException:
        """The exception of the native part, with what a strategy raised."""
        if not isinstance(error, Error) or isinstance(error, Cancellation):
            return error
        # Not in the message, which is broken over lines and has no control characters.
        said = error._causes
        failure = next((one for one in self._failures if any(one.text in text for text in said)), None)
        if failure is None:
            return self._named(error)
        if not isinstance(error, StrategyError):
            error = _as_strategy_error(error)
        error.strategy = f"{failure.strategy.slot} {failure.strategy.name}"
        error.source = failure.source
        error.__cause__ = failure.error
        return error

    def _named(self, error: Error) -> Error:
        """An error that the host found in an answer, with the strategy that gave it."""
        if isinstance(error, StrategyError):
            for strategy in self.strategies:
                if f"`{strategy.name}` of " in error.title:
                    error.strategy = f"{strategy.slot} {strategy.name}"
        return error


def _refuse_more() -> None:
    """Too many calls have stayed behind."""
    with _shared:
        _left[:] = [thread for thread in _left if thread.is_alive()]
        if len(_left) >= MOST_LEFT:
            raise StrategyError(
                f"{len(_left)} earlier calls have strategies that do not come back, and each keeps its "
                "threads",
                help=("start a new process",),
            )


def _text_of(error: BaseException) -> str:
    """The text of an exception. Its own method may raise as well."""
    try:
        return str(error)
    except Exception as second:
        return f"(its text raises {type(second).__name__})"


def _as_strategy_error(error: Error) -> StrategyError:
    """An error that turnpath takes for the recipe's, although a strategy of Python raised."""
    return StrategyError(str(error), title=error.title, places=error.places, help=error.help)


def _source_of(error: BaseException) -> str | None:
    """File and line of the innermost frame that is not turnpath's own."""
    frames = traceback.extract_tb(error.__traceback__)
    for frame in reversed(frames):
        if not frame.filename.startswith(_PACKAGE):
            return f"{Path(frame.filename).name}, line {frame.lineno}"
    return None
