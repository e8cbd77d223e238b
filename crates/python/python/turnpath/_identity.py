"""What tells a strategy from another one of its name: the hash of all that its answers depend on.

The hash has the source, the code, and every value that a function takes from around it: defaults,
values of closures and of its module, the functions and classes of its module, what a partial function
or an object holds. What an import brings stands in it by its name. A value that has no exact hash is
no reason to guess: there is no identity then, and no record of an ablation is used again.
"""

from __future__ import annotations

import builtins
import dis
import enum
import functools
import hashlib
import logging
import re
import sys
import types
from collections.abc import Iterable
from pathlib import PurePath
from typing import Any

import numpy as np

from . import _source

# Values whose `repr` says all of them.
_PLAIN = (bool, int, float, complex, str, bytes, type(None), type(...), range)
# What a class has from its source, or from Python.
_OF_CLASS = frozenset(
    "__dict__ __weakref__ __doc__ __module__ __qualname__ __annotations__ __annotate__ __annotate_func__ "
    "__annotations_cache__ __static_attributes__ __firstlineno__ __dataclass_fields__ "
    "__dataclass_params__ __abstractmethods__ _abc_impl __parameters__ __orig_bases__".split()
)
# Containers in containers are looked into so deep; what is deeper may hold itself.
_DEEPEST = 16


class _Bare:
    """An object that holds nothing but its attributes."""


class NoIdentity(Exception):
    """Something that the answers depend on has no exact hash; the text says what."""


def identity(parts: Iterable[tuple[str, Any]], own: set[str]) -> str:
    """SHA-256 of named parts. The functions and classes of the modules ``own`` count with what they
    hold, those of others by their names.

    Raises:
        NoIdentity: when a part has no exact hash.
    """
    writer = _Writer(own)
    for name, part in parts:
        writer.write("part", name)
        writer.value(part, name)
    return writer.hash.hexdigest()


class _Writer:
    """Writes values into a hash, so that other values are other bytes."""

    def __init__(self, own: set[str]) -> None:
        self.own = own
        self.hash = hashlib.sha256()
        # Functions, classes and objects that were written, by their ids, and what keeps these valid.
        self.seen: dict[int, int] = {}
        self.kept: list[Any] = []
        self.depth = 0

    def write(self, *words: str | bytes) -> None:
        for word in words:
            data = word if isinstance(word, bytes) else word.encode("utf-8", "surrogatepass")
            self.hash.update(f"{len(data)}:".encode())
            self.hash.update(data)

    def value(self, value: Any, name: str) -> None:
        """Writes a value; ``name`` is what a message calls it."""
        kind = type(value)
        if kind in _PLAIN:
            self.write(kind.__name__, repr(value))
        elif kind is np.ndarray or isinstance(value, np.generic):
            self._array(value, name)
        elif kind in (list, tuple, set, frozenset, dict):
            self._container(value, name)
        elif isinstance(value, types.ModuleType):
            self.write("module", value.__name__, str(getattr(value, "__version__", "")))
        elif isinstance(value, PurePath):
            self.write("path", str(value))
        elif kind is re.Pattern:
            self.write("pattern", str(value.flags))
            self.value(value.pattern, name)
        elif isinstance(value, tuple) and vars(kind).keys() >= {"_fields", "_make"}:
            self.write("named", kind.__qualname__, repr(value._fields))
            self.value(tuple(value), name)
        elif isinstance(value, enum.Enum):
            self.write("member", value.name)
            self.value(kind, name)
        elif isinstance(value, np.ufunc):
            self._ufunc(value, name)
        elif isinstance(value, logging.Logger):
            self.write("logger", value.name)
        elif self._is_imported(value):
            self.write("import", value.__module__, value.__qualname__)
        elif id(value) in self.seen:
            self.write("again", str(self.seen[id(value)]))
        else:
            self.seen[id(value)] = len(self.seen)
            self.kept.append(value)
            self._whole(value, name)

    def _whole(self, value: Any, name: str) -> None:
        """Writes what may refer to itself."""
        kind = type(value)
        if kind is types.FunctionType:
            self._function(value)
        elif kind is functools.partial:
            self.write("partial")
            self.value([value.func, value.args, value.keywords, vars(value)], name)
        elif kind is types.MethodType:
            self.write("method")
            self.value([value.__func__, value.__self__], name)
        elif isinstance(value, functools._lru_cache_wrapper):
            self.write("cache")
            self.value(value.__wrapped__, name)
        elif isinstance(value, type):
            self._class(value, name)
        elif hasattr(kind, "_identity_parts"):
            self.write("strategy")
            self.value(list(value._identity_parts()), name)
        elif kind.__basicsize__ == _Bare.__basicsize__ and hasattr(value, "__dict__"):
            self.write("object")
            self.value([kind, vars(value)], name)
        else:
            raise NoIdentity(f"it takes `{name}`, and a value of type {_said(kind)} has no exact hash")

    def _is_imported(self, value: Any) -> bool:
        """Whether a value is what an import brings: its module has it under its name, and is none of
        the strategy's own."""
        module, name = getattr(value, "__module__", None), getattr(value, "__qualname__", None)
        if not isinstance(module, str) or not isinstance(name, str) or module in self.own:
            return False
        found: Any = sys.modules.get(module)
        for part in name.split("."):
            found = getattr(found, part, None)
        return found is value

    def _ufunc(self, value: np.ufunc, name: str) -> None:
        for module in ("numpy", "scipy.special"):
            if getattr(sys.modules.get(module), value.__name__, None) is value:
                self.write("ufunc", module, value.__name__)
                return
        raise NoIdentity(f"it takes `{name}`, and a numpy.ufunc of its own has no exact hash")

    def _array(self, value: Any, name: str) -> None:
        if value.dtype.hasobject:
            raise NoIdentity(f"it takes `{name}`, and an array of objects has no exact hash")
        self.write("array", repr(value.dtype.descr), repr(value.shape), value.tobytes())

    def _container(self, value: Any, name: str) -> None:
        self.depth += 1
        if self.depth > _DEEPEST:
            raise NoIdentity(f"it takes `{name}`, which holds values too deep to hash")
        self.write(type(value).__name__, str(len(value)))
        if isinstance(value, dict):
            for key, item in value.items():
                self.value(key, name)
                self.value(item, name)
        else:
            ordered = sorted(value, key=repr) if isinstance(value, (set, frozenset)) else value
            for item in ordered:
                self.value(item, name)
        self.depth -= 1

    def _function(self, function: Any) -> None:
        """Writes the source of a function, its code, and all that it takes from around it."""
        self.write("function", function.__qualname__, _source.bytes_of(function))
        self._code(function.__code__)
        self.value(function.__defaults__, "a default")
        self.value(function.__kwdefaults__, "a default")
        for name, value in sorted(vars(function).items()):
            self.write(name)
            self.value(value, f"{function.__name__}.{name}")
        for name, cell in zip(function.__code__.co_freevars, function.__closure__ or ()):
            self.write(name)
            try:
                held = cell.cell_contents
            except ValueError:
                self.write("empty")
            else:
                self.value(held, name)
        for name in sorted(_global_names(function.__code__)):
            self.write(name)
            if name in function.__globals__:
                self.value(function.__globals__[name], name)
            else:
                self.write("builtin" if hasattr(builtins, name) else "missing")

    def _code(self, code: types.CodeType) -> None:
        """Writes what a function does: two of one line in one file may differ."""
        self.write("code", code.co_code, repr(code.co_names), repr(code.co_varnames))
        for constant in code.co_consts:
            if isinstance(constant, types.CodeType):
                self._code(constant)
            else:
                self.value(constant, "a constant")

    def _class(self, kind: type, name: str) -> None:
        """Writes a class of the function's own module, or one that was made within a function."""
        self.write("class", kind.__qualname__)
        if issubclass(kind, enum.Enum):
            self.value([(one.name, one.value) for one in kind], name)
            return
        for base in kind.__bases__:
            self.value(base, name)
        for key, held in sorted(vars(kind).items()):
            if key in _OF_CLASS:
                continue
            self.write(key)
            if isinstance(held, property):
                self.value([held.fget, held.fset, held.fdel], key)
            elif isinstance(held, (staticmethod, classmethod)):
                self.write(type(held).__name__)
                self.value(held.__func__, key)
            else:
                self.value(held, f"{kind.__name__}.{key}")


def _global_names(code: types.CodeType) -> set[str]:
    """The names that code takes from its module, that of inner functions too."""
    names = {
        step.argval
        for step in dis.get_instructions(code)
        if "GLOBAL" in step.opname or step.opname == "LOAD_NAME"
    }
    inner = (one for one in code.co_consts if isinstance(one, types.CodeType))
    return names.union(*map(_global_names, inner))


def _said(kind: type) -> str:
    return kind.__qualname__ if kind.__module__ == "builtins" else f"{kind.__module__}.{kind.__qualname__}"
