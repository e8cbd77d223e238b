"""Recipes: from a file, a text or a dict."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any, Union

import tomli_w

from ._errors import FileError


class Recipe:
    """A recipe: its text, where it is, and the changes to it.

    Args:
        source: the path of a recipe, or a dict with its tables. Quantities of a dict are texts with
            units, as in a file: ``{"tool": {"nose_radius": "1 mm"}}``.
        folder: where the files lie that a dict names; the current folder unless given.
    """

    def __init__(
        self,
        source: Union[str, os.PathLike[str], Mapping[str, Any]],
        *,
        folder: Union[str, os.PathLike[str], None] = None,
    ) -> None:
        if isinstance(source, Mapping):
            self.text = tomli_w.dumps(_plain(source))
            self.path = Path(folder or ".") / "recipe.toml"
        else:
            self.path = Path(source)
            try:
                self.text = self.path.read_text(encoding="utf-8")
            except (OSError, UnicodeDecodeError) as error:
                raise FileError(f"cannot read {self.path}: {error}") from error
        self.sets: tuple[str, ...] = ()

    @classmethod
    def from_text(cls, text: str, path: Union[str, os.PathLike[str]] = "recipe.toml") -> Recipe:
        """The recipe of this text. Messages name ``path``, and files are relative to it."""
        recipe = cls.__new__(cls)
        recipe.text, recipe.path, recipe.sets = text, Path(path), ()
        return recipe

    def set(self, changes: Mapping[str, Any]) -> Recipe:
        """The recipe with these values in the places of its own: ``{"tool.nose_radius": "2 mm"}``."""
        recipe = Recipe.from_text(self.text, self.path)
        recipe.sets = self.sets + tuple(f"{key}={_written(value)}" for key, value in changes.items())
        return recipe

    def _native(self) -> tuple[str, str, list[str]]:
        return (self.text, str(self.path), list(self.sets))

    def __repr__(self) -> str:
        return f"Recipe({str(self.path)!r}, sets={list(self.sets)!r})"


def _plain(value: Any) -> Any:
    """Numbers of numpy and tuples as plain ones."""
    if isinstance(value, Mapping):
        return {str(key): _plain(item) for key, item in value.items()}
    if isinstance(value, (list, tuple)):
        return [_plain(item) for item in value]
    # Arrays and numbers of numpy.
    return value.tolist() if hasattr(value, "tolist") else value


def _written(value: Any) -> str:
    """A value as ``--set`` takes it: a text as it is, else TOML on one line."""
    value = _plain(value)
    return value if isinstance(value, str) else _on_one_line(value)


def _on_one_line(value: Any) -> str:
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, (int, float)):
        return repr(value)
    if isinstance(value, str):
        return json.dumps(value, ensure_ascii=False)
    if isinstance(value, list):
        return "[" + ", ".join(_on_one_line(item) for item in value) + "]"
    if isinstance(value, Mapping):
        items = (f"{json.dumps(key)} = {_on_one_line(item)}" for key, item in value.items())
        return "{ " + ", ".join(items) + " }"
    raise TypeError(f"a recipe holds no {type(value).__name__}")


RecipeLike = Union[Recipe, str, os.PathLike, Mapping[str, Any]]


def as_recipe(recipe: RecipeLike, changes: Mapping[str, Any] | None = None) -> Recipe:
    """A recipe of whatever stands for one, with changes."""
    found = recipe if isinstance(recipe, Recipe) else Recipe(recipe)
    return found.set(changes) if changes else found
