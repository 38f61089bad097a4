"""Studies: the quantities of a scene for many values of its parameters, by the factors of one run."""

from __future__ import annotations

import csv
import io
import itertools
import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import h5py
import numpy as np
from numpy.typing import NDArray

from contact_dd import errors, files

if TYPE_CHECKING:
    from matplotlib.figure import Figure

# The kinds of parameters, by their numbers in the problem file, that leave all factors as they are.
VARYING = (0, 2, 4)


@dataclass(frozen=True)
class Study:
    """The table of a study: a row a case."""

    parameters: tuple[str, ...]
    """Names of the parameters."""
    values: NDArray[np.float64]
    """Values of the parameters in every case: factors of loads, additions to gaps, coefficients of friction."""
    quantities: dict[str, NDArray[np.float64]]
    """The quantities by their names, a number a case; NaN where a case is ill-posed."""
    kinds: dict[str, str]
    """The kinds of quantities by their names."""
    status: tuple[str, ...]
    """Status of every case: "converged", "not_converged" or "ill_posed"."""

    def plot(self) -> Figure:
        """A picture by matplotlib: quantities over the first parameter, a line for each combination of the others."""
        from contact_dd.drawing.studies import curves

        figure: Figure = curves(self)
        return figure

    def write_csv(self, path: str | Path) -> None:
        """Writes the table as CSV."""
        text = io.StringIO()
        table = csv.writer(text, lineterminator="\n")
        table.writerow([*self.parameters, *self.quantities, "status"])
        for row, status in enumerate(self.status):
            found = [repr(float(of[row])) for of in self.quantities.values()]
            table.writerow([*map(repr, map(float, self.values[row])), *found, status])
        files.write(Path(path), text.getvalue())

    def write_hdf5(self, path: str | Path) -> None:
        """Writes the table as HDF5: `parameters`, `values`, `quantities`, `kinds`, `status`, and `table`, of whose
        quantities every case has a row."""
        try:
            with h5py.File(path, "w") as file:
                file["parameters"] = list(self.parameters)
                file["values"] = self.values
                file["quantities"] = list(self.quantities)
                file["kinds"] = list(self.kinds.values())
                file["table"] = np.stack(list(self.quantities.values()), -1)
                file["status"] = list(self.status)
        except OSError as error:
            raise errors.OutputError(f"{path}: can't be written: {error}") from error


def cases_of(problem: Path, vary: Mapping[str, Sequence[float]]) -> dict[str, Any]:
    """The cases of a study as `contact-dd-mpi --study` reads them: all combinations of the values."""
    if not vary:
        raise errors.InputError("a study varies nothing; expected the name of a parameter and its values")
    with h5py.File(problem) as file:
        known: dict[str, int] = {}
        if "parameter/name" in file:
            names = file["parameter/name"].asstr()[:]
            known = dict(zip(names, map(int, file["parameter/kind"][:]), strict=True))
    names = [parameter(name, known) for name in vary]
    for name in names:
        if names.count(name) > 1:
            raise errors.InputError(f"parameter {name!r} is varied twice")
    values = [numbers(name, of) for name, of in vary.items()]
    return {"parameters": names, "cases": [list(case) for case in itertools.product(*values)]}


def numbers(name: str, values: Any) -> list[float]:
    """The values of a parameter: a list of finite numbers."""
    expected = "expected a list of finite numbers, such as [1.0, 2.0]"
    if isinstance(values, str):
        raise errors.InputError(f"parameter {name!r}: the values are {values!r}; {expected}")
    try:
        found = [float(value) for value in values]
    except (TypeError, ValueError):
        raise errors.InputError(f"parameter {name!r}: the values are {values!r}; {expected}") from None
    for value in found:
        if not np.isfinite(value):
            raise errors.InputError(f"parameter {name!r}: one of the values is {value}; {expected}")
    return found


def parameter(asked: str, known: Mapping[str, int]) -> str:
    """The name of the only parameter that has the one that is `asked` for in it, or is it."""
    if asked in known:
        return asked
    can_vary = [name for name, kind in known.items() if kind in VARYING]
    found = [name for name in can_vary if asked in name]
    if len(found) == 1:
        return found[0]
    if not known:
        raise errors.InputError(f"nothing to vary as {asked!r}: the scene asks for no quantity")
    what = "several parameters have" if found else "no parameter has"
    listed = ", ".join(map(repr, found or can_vary))
    raise errors.InputError(
        f"{what} {asked!r} in its name; a study of this scene varies loads, gaps and friction: {listed}"
    )


def read(path: Path) -> Study:
    """Reads the table that `contact-dd-mpi --study` wrote."""
    table = json.loads(path.read_text(encoding="utf-8"))
    cases, named = table["cases"], table["quantities"]
    none = [None] * len(named)
    found = np.array([case["quantities"] or none for case in cases], float).reshape(len(cases), len(named))
    return Study(
        tuple(table["parameters"]),
        np.array([case["values"] for case in cases], float),
        {of["name"]: found[:, column] for column, of in enumerate(named)},
        {of["name"]: of["kind"] for of in named},
        tuple(case["status"] for case in cases),
    )


def values_of(text: str) -> tuple[str, list[float]]:
    """A parameter and its values, from `name=first:last:step` or `name=value,value,…`."""
    name, found, values = text.rpartition("=")
    try:
        if ":" in values:
            first, last, step = map(float, values.split(":"))
            count = round((last - first) / step) + 1
            if step == 0 or count < 1 or abs(first + (count - 1) * step - last) > 1e-9 * abs(step):
                raise ValueError
            # Rounded to the decimals that a scene would have: 0.3, not 0.30000000000000004.
            numbers = [float(f"{first + k * step:.12g}") for k in range(count)]
        else:
            numbers = [float(value) for value in values.split(",")]
    except (ValueError, ZeroDivisionError, OverflowError):
        numbers = []
    if not found or not name or not numbers or not np.isfinite(numbers).all():
        raise errors.InputError(
            f"--vary {text!r}: expected name=first:last:step, where steps lead to the last value, or name=value,value,…"
        )
    return name, numbers
