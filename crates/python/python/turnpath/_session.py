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

_PACKAGE = str(Path(__file__).parent) + os.sep
_active = 0
_torn = False


def _after_fork() -> None:
    global _torn
    _torn = _torn or _active > 0


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
        self.time_limit = time_limit
        #: Half the side of the square that a spline covers, mm; ``None`` where it is not known.
        self.half_width: float | None = None
        #: The error at which a spline is fine enough, mm.
        self.fit_error = 1e-8
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
            text = f"raised {type(error).__name__}: {error}{place}"
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
        done: dict[str, Any] = {}
        thread = threading.Thread(
            target=self._body, args=(command, done), name="turnpath", daemon=True
        )
        thread.start()
        stop = self._wait(thread, progress)
        if thread.is_alive():
            raise stop if stop is not None else self._stuck()
        if stop is not None:
            raise stop
        if "error" in done:
            raise self._explained(done["error"])
        return done["answer"]

    @staticmethod
    def _body(command: Callable[[], Any], done: dict[str, Any]) -> None:
        global _active
        _active += 1
        try:
            done["answer"] = command()
        except BaseException as error:  # noqa: B902: the waiting thread raises it
            done["error"] = error
        finally:
            _active -= 1

    def _wait(
        self, thread: threading.Thread, progress: Callable[[str, int, int], Any] | None
    ) -> BaseException | None:
        """Waits until the work has ended, or a strategy does not hear. Gives what stopped it from here;
        a second Ctrl-C waits no longer."""
        stop: BaseException | None = None
        told: tuple[str, int, int] | None = None
        while thread.is_alive():
            try:
                thread.join(LOOK)
                if stop is None and progress is not None and self.control.progress() != told:
                    told = self.control.progress()
                    progress(*told)
            except BaseException as error:  # noqa: B902: Ctrl-C, or what `progress` raises
                if stop is not None:
                    return error
                stop = error
                self.control.cancel()
                self._end_calls(Interruption, lambda call: True)
            now = time.monotonic()
            if self.time_limit is not None:
                limit = self.time_limit
                self._end_calls(TimeLimit, lambda call: now - call.started > limit)
            if self._overdue(now):
                return stop
        return stop

    def _end_calls(self, kind: type[BaseException], which: Callable[[_Call], bool]) -> None:
        """Raises an exception in the innermost calls that are to end, each once."""
        with self._lock:
            for thread, calls in self._calls.items():
                if calls and calls[-1].told is None and which(calls[-1]):
                    calls[-1].told = time.monotonic()
                    ctypes.pythonapi.PyThreadState_SetAsyncExc(
                        ctypes.c_ulong(thread), ctypes.py_object(kind)
                    )

    def _overdue(self, now: float) -> bool:
        """Whether a call did not hear that it is to end."""
        with self._lock:
            calls = [call for calls in self._calls.values() for call in calls[-1:]]
        return any(call.told is not None and now - call.told > GRACE for call in calls)

    def _stuck(self) -> StrategyError:
        """The error for a call that does not come back at all. Its thread stays."""
        self.control.cancel()
        with self._lock:
            calls = [call for calls in self._calls.values() for call in calls[-1:]]
        names = ", ".join(f"{call.strategy.slot} `{call.strategy.name}`" for call in calls)
        error = StrategyError(
            f"the {names} did not come back within {self.time_limit:g} s, and does not hear that it is to "
            "end: it is in code that is not Python's"
        )
        if calls:
            error.strategy = f"{calls[0].strategy.slot} {calls[0].strategy.name}"
        return error

    def _explained(self, error: BaseException) -> BaseException:
        """The exception of the native part, with what a strategy raised."""
        if not isinstance(error, Error) or isinstance(error, Cancellation):
            return error
        text = str(error)
        # A message may be broken over lines where it is underlined.
        failure = next((one for one in self._failures if one.text in text), None)
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
