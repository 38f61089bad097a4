"""The calls that made the parts of a scene: messages name these instead of lines, which the user hasn't written."""

from __future__ import annotations

import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any

# Parts of a scene as messages name them: `pressure[2]`, `contact[1] 'joint'`, `bodies.block`, `materials."material 1"`.
NAME = r"""(?: '(?:[^'\\]|\\.)*')?"""
ENTRY = re.compile(rf"(?<![\w.])(\w+)\[(\d+)\]{NAME}(?: on '[^']*')?")
TABLE = re.compile(r"""(?<![\w.])(bodies|materials)\.("(?:[^"\\]|\\.)*"|[\w-]+)""")


class Calls:
    """The calls that made entries of a scene, by entry."""

    def __init__(self) -> None:
        self._made: list[tuple[dict[str, Any], str]] = []

    def add(self, entry: dict[str, Any], call: str) -> None:
        """Notes the call that made an entry."""
        self._made.append((entry, call))

    def worded(self, message: str, scene: Mapping[str, Any], written: Path, name: str) -> str:
        """A message of the programs on the scene that was `written`, with calls in place of its lines and entries, and
        the scene and its mesh under the caller's names, the scene without a name if that is empty."""

        def of_entry(found: re.Match[str]) -> str:
            entries, number = scene.get(found[1]), int(found[2])
            if not isinstance(entries, list) or not 0 < number <= len(entries):
                return found[0]
            return self._of(entries[number - 1]) or found[0]

        def of_table(found: re.Match[str]) -> str:
            key = found[2].strip('"')
            bodies = scene.get("bodies", {})
            if found[1] == "materials":
                key = next((group for group, body in bodies.items() if body.get("material") == key), "")
            made_by = self._of(bodies.get(key))
            return found[0] if made_by is None else f"{'material of ' * (found[1] == 'materials')}{made_by}"

        prefix = f"{name}: " if name else ""
        message = re.sub(rf"{re.escape(str(written))}: (line \d+: )?", lambda _: prefix, message)
        message = message.replace(str(written.with_name("mesh.msh")), "the model's mesh")
        return TABLE.sub(of_table, ENTRY.sub(of_entry, message))

    def _of(self, entry: Any) -> str | None:
        return next((call for made, call in self._made if made is entry), None)


def call(method: str, *positional: Any, **named: Any) -> str:
    """A call as it was written; arguments that are None weren't given."""
    given = [repr(value) for value in positional if value is not None]
    given += [f"{name}={value!r}" for name, value in named.items() if value is not None]
    return f"{method}({', '.join(given)})"
