"""Meshes that adapt: solve, see where the error is, mesh again, until it is as small as asked."""

from __future__ import annotations

import time
import warnings
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from contact_dd.errors import InputError, NotConverged, OutputError
from contact_dd.geometry import meshed
from contact_dd.model import Model
from contact_dd.result import Result
from contact_dd.sizes import errors_of, relative_errors, sizes_for

MOST_ROUNDS = 12

# A round divides the error by no more than this: where fields are singular the order of convergence is lost, and
# several small rounds find that out at less cost than a large one.
MOST_PER_ROUND = 9.0

# Target of a round over the requested error; multiplied again if a round ends close above the request, as a mesher
# doesn't quite reach the prescribed sizes.
AIM = 0.9


@dataclass(frozen=True)
class Round:
    """A mesh on the way."""

    dofs: int
    error: float
    """Estimated and relative: in the energy norm, or of the quantity."""
    seconds: float
    """Since the first mesh was begun."""
    result: Result
    """Of a folder that was given the file is `scene-1.vtkhdf` and so on, in the last round `scene.vtkhdf`."""


def adapt(
    model: Model, error: float, geometry: str | Path | None = None, *, quantity: str | None = None, ranks: int = 2,
    folder: str | Path | None = None, progress: bool = True,
) -> tuple[Result, list[Round]]:
    """Meshes and solves a model until the estimated error, relative and in the energy norm, is at most `error`, in
    every load step; with the name of one of its quantities that of the `quantity`, in the last load step.

    `geometry` is a file that Gmsh meshes, with the groups of the model; without one it is Gmsh's current model. The
    first mesh has the sizes that the geometry asks for; the last one is that of the model then. Cells are quadratic.

    Warnings are those of the last mesh. Raises `NotConverged` where the error is still larger after 12 rounds.
    """
    if not 0 < error < 1:
        raise InputError(f"an error of {error}; expected one above 0 and below 1")
    wanted: list[dict[str, Any]] = model.scene.get("quantity", [])
    if quantity is not None and quantity not in (names := [one["name"] for one in wanted]):
        known = ", ".join(map(repr, names)) or "none, as the model asks for none"
        raise InputError(f"there is no quantity {quantity!r}; known are {known}")
    order = wanted.copy()
    path = None if geometry is None else Path(geometry)
    start, sizes, rounds, aim = time.perf_counter(), None, list[Round](), AIM * error
    printed: list[warnings.WarningMessage] = []
    try:
        # Cells have errors of the first one.
        wanted.sort(key=lambda one: quantity is not None and one["name"] != quantity)
        while True:
            if folder is not None and rounds:
                keep(rounds[-1].result, len(rounds))
            model.mesh = meshed(path, sizes)
            # Warnings of a mesh that the next one replaces don't matter.
            with warnings.catch_warnings(record=True) as printed:
                warnings.simplefilter("always")
                result = model.run(ranks, folder=folder, progress=False)
            found, squares = relative_errors(result) if quantity is None else errors_of(result, quantity)
            rounds.append(Round(result.report["dofs"], found, time.perf_counter() - start, result))
            if progress:
                last = rounds[-1]
                print(f"round {len(rounds)}: {last.dofs:8} dofs, error {found:.2%}, {last.seconds:.1f} s", flush=True)
            if found <= error:
                return result, rounds
            if len(rounds) == MOST_ROUNDS:
                late = NotConverged(f"after {MOST_ROUNDS} meshes the error is {found:.2g}, above {error:g}")
                late.result = result
                raise late
            goal = max(aim, found / MOST_PER_ROUND)
            # Of an error in the energy norm the squares of cells' errors add up.
            sizes = sizes_for(result, squares, goal**2 if quantity is None else goal, is_first=len(rounds) == 1)
            if found < 2 * error:
                aim *= AIM
    finally:
        wanted[:] = order
        for message, category in dict.fromkeys((str(one.message), one.category) for one in printed):
            warnings.warn(message, category, stacklevel=2)


def keep(result: Result, number: int) -> None:
    """Gives the result of a round another name, as the next one is about to be written in its place."""
    kept = result.path.with_name(f"{result.path.stem}-{number}{result.path.suffix}")
    try:
        result.path.replace(kept)
    except OSError as error:
        raise OutputError(f"{kept}: can't be written: {error.strerror}") from error
    result.path = kept
