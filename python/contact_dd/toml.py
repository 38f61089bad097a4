"""A scene as TOML."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator, Mapping
from typing import Any

from contact_dd.errors import InputError


def dumps(scene: Mapping[str, Any]) -> str:
    """A scene as text: values first, then a table `[kind.name]` for each entry of a mapping and a `[[kind]]` for
    each of a list of mappings."""
    return "\n".join(lines(scene)) + "\n"


def lines(scene: Mapping[str, Any]) -> Iterator[str]:
    for name, value in scene.items():
        if not is_table(value) and not is_list_of_tables(value):
            yield f"{key(name)} = {inline(value)}"
    for name, value in scene.items():
        if is_list_of_tables(value):
            for entry in value:
                yield f"\n[[{key(name)}]]"
                yield from entries(entry)
        elif is_table(value) and value and all(is_table(entry) for entry in value.values()):
            for inner, entry in value.items():
                yield f"\n[{key(name)}.{key(inner)}]"
                yield from entries(entry)
        elif is_table(value):
            yield f"\n[{key(name)}]"
            yield from entries(value)


def entries(table: Mapping[str, Any]) -> Iterator[str]:
    return (f"{key(name)} = {inline(value)}" for name, value in table.items())


def is_table(value: Any) -> bool:
    return isinstance(value, Mapping)


def is_list_of_tables(value: Any) -> bool:
    return isinstance(value, list) and bool(value) and all(is_table(entry) for entry in value)


def key(name: str) -> str:
    if not isinstance(name, str):
        raise InputError(f"{name!r} can't be a key of a scene; expected a text")
    return name if re.fullmatch("[A-Za-z0-9_-]+", name) else text(name)


def text(value: str) -> str:
    # TOML has JSON's escapes and one more.
    written = json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")
    if any("\ud800" <= letter <= "\udfff" for letter in value):
        raise InputError(f"{value!r} can't stand in a scene; expected whole characters, no halves of them")
    return written


def inline(value: Any) -> str:
    """A value on one line; numbers and arrays of NumPy count as numbers and lists."""
    if hasattr(value, "tolist"):
        value = value.tolist()
    if isinstance(value, str):
        return text(value)
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, int | float):
        return repr(value)
    if is_table(value):
        return "{ " + ", ".join(entries(value)) + " }"
    if isinstance(value, list | tuple):
        return "[" + ", ".join(inline(entry) for entry in value) + "]"
    raise InputError(f"{value!r} can't stand in a scene; expected a number, a text, a list or a mapping")
