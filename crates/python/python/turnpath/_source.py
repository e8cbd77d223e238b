"""Where a function's source is, and the hash that stands for it."""

from __future__ import annotations

import hashlib
import inspect
from pathlib import Path
from typing import Any, Callable

import numpy as np

# Values whose text says all of them.
_PLAIN = (bool, int, float, complex, str, bytes, type(None))
# Containers of values are looked into so deep.
_DEEPEST = 4


def file_of(function: Callable[..., Any]) -> str:
    """The file of a function's source, or what stands for one where there is none."""
    return inspect.getsourcefile(function) or function.__code__.co_filename


def digest(function: Callable[..., Any]) -> str:
    """SHA-256 of a function's source, of the plain values that it takes from outside, and of the
    functions of its own module that it calls.

    What a function does also depends on the modules that it imports. Their sources do not count.
    """
    hash = hashlib.sha256()
    _add(hash, function, set())
    return hash.hexdigest()


def _add(hash: Any, function: Callable[..., Any], seen: set[int]) -> None:
    if id(function) in seen:
        return
    seen.add(id(function))
    path = Path(file_of(function))
    if path.is_file():
        hash.update(path.read_bytes())
    else:
        hash.update(_text(function).encode())
    try:
        outside = inspect.getclosurevars(function)
    except (TypeError, ValueError):
        return
    for name, value in sorted({**outside.globals, **outside.nonlocals}.items()):
        inner = inspect.unwrap(value) if callable(value) else value
        if inspect.isfunction(inner):
            hash.update(name.encode())
            # The source of another module is its own affair; a value in a closure is not.
            if inner.__module__ == function.__module__ or name in outside.nonlocals:
                _add(hash, inner, seen)
        else:
            hash.update(f"{name}={_value(value)}".encode())


def _text(function: Callable[..., Any]) -> str:
    """The source of a function that is in no file, such as one of a notebook."""
    try:
        return inspect.getsource(function)
    except (OSError, TypeError):
        code = function.__code__
        return f"{code.co_code.hex()} {code.co_names} {_value(code.co_consts)}"


def _value(value: Any, depth: int = 0) -> str:
    """A text that is another one for another value, as far as plain values go."""
    if isinstance(value, _PLAIN):
        return repr(value)
    if isinstance(value, np.ndarray):
        return f"{value.dtype}{value.shape}{hashlib.sha256(value.tobytes()).hexdigest()}"
    if isinstance(value, np.generic):
        return repr(value.item())
    if depth < _DEEPEST and isinstance(value, (list, tuple, set, frozenset)):
        items = [_value(item, depth + 1) for item in value]
        return f"{type(value).__name__}{sorted(items) if isinstance(value, (set, frozenset)) else items}"
    if depth < _DEEPEST and isinstance(value, dict):
        return str({str(key): _value(item, depth + 1) for key, item in value.items()})
    return type(value).__qualname__
