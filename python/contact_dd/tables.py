"""Contacts as tables of text, CSV: a row for each condition, in the plane along the arc length of side a."""

from __future__ import annotations

import csv
import io
import re
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from contact_dd import files

if TYPE_CHECKING:
    from contact_dd.result import Result


FIRST = ("position", "pressure", "gap", "force", "status")


def write_tables(result: Result, folder: str | Path) -> list[Path]:
    """Writes `<contact>.csv` for every contact that has conditions; returns the paths. Raises `OutputError`."""
    from contact_dd.drawing.sides import sides_of

    folder = Path(folder)
    sides = sides_of(result)
    paths: list[Path] = []
    for name, table in result.contacts_there.items():
        if not len(table):
            continue
        # The last row of a piece that is closed is its first.
        pieces = [
            (row, {"piece": k + 1, "arc_length": float(length)})
            for k, (rows, lengths) in enumerate(sides[name].pieces if name in sides else [])
            for row, length in list(zip(rows, lengths, strict=True))[: len(set(rows))]
        ] or [(row, {}) for row in range(len(table))]
        stem = re.sub(r"[^\w .-]", "_", name)
        path = folder / f"{stem}.csv"
        if path in paths:
            path = folder / f"{stem} {len(paths) + 1}.csv"
        records = [{**along, **columns(table[row], 3 if result.is_in_space else 2)} for row, along in pieces]
        text = io.StringIO()
        writer = csv.DictWriter(text, records[0])
        writer.writeheader()
        writer.writerows(records)
        files.write(path, text.getvalue())
        paths.append(path)
    return paths


def columns(row: np.void, dim: int) -> dict[str, Any]:
    """The columns of a condition, a column for each component of a vector."""
    assert row.dtype.names
    names = [*FIRST, *(name for name in row.dtype.names if name not in FIRST)]
    found: dict[str, Any] = {}
    for name in names:
        value = row[name]
        if value.ndim == 0:
            found[name] = value.item()
            continue
        prefix = "" if name == "position" else f"{name}_"
        found |= {f"{prefix}{axis}": float(component) for axis, component in zip("xyz"[:dim], value, strict=False)}
    return found
