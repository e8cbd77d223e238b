"""Where a function's source is, and the bytes of it."""

from __future__ import annotations

import hashlib
import inspect
import warnings
from pathlib import Path
from typing import Any, Callable


def file_of(function: Callable[..., Any]) -> str:
    """The file of a function's source, or what stands for one where there is none."""
    return inspect.getsourcefile(function) or function.__code__.co_filename


def warn_at(function: Callable[..., Any], text: str, category: type[Warning]) -> None:
    """Warns at the line where a function begins: the call that finds out is one of turnpath's own."""
    function = inspect.unwrap(function)
    warnings.warn_explicit(
        text,
        category,
        filename=file_of(function),
        lineno=function.__code__.co_firstlineno,
        module=function.__module__,
        registry=function.__globals__.setdefault("__warningregistry__", {}),
    )


def has_file(function: Callable[..., Any]) -> bool:
    """Whether the source is a file; that of a notebook is none."""
    return Path(file_of(function)).is_file()


def bytes_of(function: Callable[..., Any]) -> bytes:
    """The bytes of the source: those of the file, or the text of the function where there is none."""
    try:
        return Path(file_of(function)).read_bytes()
    except OSError:
        return _text(function).encode()


def sha256(function: Callable[..., Any]) -> str:
    """SHA-256 of the bytes of the source, as ``sha256sum`` gives it for the file."""
    return hashlib.sha256(bytes_of(function)).hexdigest()


def _text(function: Callable[..., Any]) -> str:
    """The source of a function that is in no file."""
    try:
        return inspect.getsource(function)
    except (OSError, TypeError):
        return f"{function.__qualname__} {function.__code__.co_code.hex()}"
