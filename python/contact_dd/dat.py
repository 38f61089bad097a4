"""Tables of displacements, forces, strains and stresses as CalculiX prints them for *NODE PRINT and *EL PRINT."""

from __future__ import annotations

import warnings
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from contact_dd import files
from contact_dd.printed import Printed
from contact_dd.result import Result

HEADS = {
    "U": "displacements (vx,vy,vz)", "RF": "forces (fx,fy,fz)", "EVOL": "volume (element, volume)",
    "S": "stresses (elem, integ.pnt.,sxx,syy,szz,sxy,sxz,syz)",
    "E": "strains (elem, integ.pnt.,exx,eyy,ezz,exy,exz,eyz)",
}
TOTALS = {"RF": "total force (fx,fy,fz)", "EVOL": "total volume"}


def write_dat(result: Result, prints: dict[str, Any], path: Path) -> bool:
    """Writes the tables requested by a deck, at the end of every step, from the `prints` of
    `contact-dd-partition --write-prints`; returns whether there are any. Raises `InputError` where the problem file
    isn't beside the result."""
    if not any(prints["steps"]):
        return False
    text = []
    for step, tables in enumerate(prints["steps"], start=1):
        of_step = Printed(result.at_step(step), prints)
        text.append(f"\n                        S T E P {step:7d}\n\n\n{' ' * 32}INCREMENT     1\n\n")
        for table in tables:
            text += table_of(of_step, table)
    for message in sorted(set(Printed.left_out(prints, result.plane))):
        warnings.warn(message, stacklevel=2)
    files.write(path, "".join(text))
    return True


def table_of(printed: Printed, table: dict[str, str]) -> Iterator[str]:
    label, name = table["label"], table["set"]
    if label in printed.without:
        return
    behind = f" for set {name} and time {time_of(printed.time)}\n\n"
    numbers, points, rows = printed.rows(label, name)
    if not numbers:
        return
    if table["totals"] != "ONLY" or label not in TOTALS:
        yield f"\n {HEADS[label]}{behind}"
        for number, point, row in zip(numbers, points, rows, strict=True):
            yield f"{number:10d}{'' if point is None else f' {point:3d}'}{numbers_of(row)}\n"
    if table["totals"] != "NO" and label in TOTALS:
        yield f"\n {TOTALS[label]}{behind}      {numbers_of(rows.sum(axis=0))}\n"


def numbers_of(row: NDArray[np.float64]) -> str:
    # Three digits of an exponent have no place.
    return "".join(f" {0.0 if abs(value) < 1e-99 else value + 0.0:13.6E}" for value in row)


def time_of(time: float) -> str:
    """A time as Fortran's E14.7 has it, with a mantissa below 1."""
    mantissa, exponent = f"{abs(time):.6E}".split("E")
    shift = 1 if time else 0
    sign = "-" if time < 0 else " "
    return f"{sign}0.{mantissa.replace('.', '')}E{int(exponent) + shift:+03d}"
