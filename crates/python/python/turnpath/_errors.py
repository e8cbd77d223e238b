"""The exceptions of turnpath. Each knows what is wrong, where in the recipe, and what helps."""

from __future__ import annotations

from typing import Any, NamedTuple


class Place(NamedTuple):
    """A place in a recipe. Lines and columns count from 1."""

    file: str
    line: int
    column: int
    text: str

    def __str__(self) -> str:
        return f"{self.file}:{self.line}:{self.column}"


class Error(Exception):
    """What could not be done. ``str`` gives the whole message.

    Attributes:
        title: what is wrong, in one line.
        places: the places in the recipe that the message underlines.
        help: what may be done about it, a text for each way.
    """

    def __init__(
        self,
        message: str,
        *,
        title: str | None = None,
        places: tuple[Place, ...] = (),
        help: tuple[str, ...] = (),
    ) -> None:
        super().__init__(message)
        self.title = title if title is not None else message
        self.places = places
        self.help = help
        # What the stages below said, each in its own words.
        self._causes: tuple[str, ...] = ()

    @property
    def place(self) -> Place | None:
        """The first place in the recipe, or ``None``."""
        return self.places[0] if self.places else None


class RecipeError(Error):
    """The recipe, or the call, asks for what cannot be done."""


class StrategyError(Error):
    """A strategy failed: it raised, gave a bad answer, or did not come back.

    ``__cause__`` is what a strategy of Python raised.

    Attributes:
        strategy: slot and name of the strategy of Python that failed, such as ``"sampler even"``;
            ``None`` for a strategy that is built in.
        source: file and line at which it failed; ``None`` where that is not known.
    """

    strategy: str | None = None
    source: str | None = None


class FileError(Error):
    """A file could not be read or written."""


class Cancellation(Error):
    """The command was cancelled."""


class TimeLimit(BaseException):
    """Raised inside of a strategy that takes too long. No ``except Exception`` catches it."""


class Interruption(BaseException):
    """Raised inside of a strategy when the command was cancelled."""


class TraceError(TypeError):
    """A surface does something that no formula can do, so it cannot be traced."""


_KINDS: dict[str, type[Error]] = {
    "request": RecipeError,
    "plugin": StrategyError,
    "files": FileError,
    "cancelled": Cancellation,
}


def of_native(found: dict[str, Any]) -> Error:
    """The exception for an error that the native part describes."""
    error = _KINDS[found["fault"]](
        found["text"] or found["title"],
        title=found["title"],
        places=tuple(Place(*place) for place in found["places"]),
        help=tuple(found["help"]),
    )
    error._causes = tuple(found["causes"])
    return error
