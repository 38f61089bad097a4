"""Sizes of cells for an error that is asked, from the errors that they have."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from contact_dd.errors import InputError
from contact_dd.result import Floats, Result

# By Gmsh's letters for kinds of cells their edges between corners, and by VTK's numbers the letter and the order.
EDGES = {
    "T": [(0, 1), (1, 2), (2, 0)],
    "Q": [(0, 1), (1, 2), (2, 3), (3, 0)],
    "S": [(0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)],
    "H": [(0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4), (0, 4), (1, 5), (2, 6), (3, 7)],
}
CORNERS = {"T": 3, "Q": 4, "S": 4, "H": 8}
KINDS = {
    5: ("T", 1), 22: ("T", 2), 9: ("Q", 1), 23: ("Q", 2), 28: ("Q", 2),
    10: ("S", 1), 24: ("S", 2), 12: ("H", 1), 25: ("H", 2), 29: ("H", 2),
}

# A cell with that many times the mean of squared errors lies at a singularity, after the first round: there smooth
# errors are about equal.
SINGULAR = 4.0

# Bounds of a cell's size after a round over that before, and of the change of sizes along a length.
LEAST, MOST, GRADATION = 1 / 30, 2.0, 0.5


@dataclass
class SizeField:
    """Sizes at the corners of cells, by Gmsh's letter for their kind: where the corners are, (cells, corners, 3), and
    the sizes, (cells, corners)."""

    cells: list[tuple[str, Floats, Floats]]


def relative_errors(result: Result) -> tuple[float, Floats]:
    """The estimated error relative to the energy norm and the square of that of each cell, of all load steps the
    largest."""
    of_cells = np.zeros(len(result.cell_data["Subdomain"]))
    largest = 0.0
    for step in range(1, result.steps + 1):
        of_step = result if step == result.step else result.at_step(step)
        estimate = (result.report["steps"][step - 1] if result.steps > 1 else result.report)["error_estimate"]
        if estimate is None:
            raise InputError("the run made no estimate of the error; expected one without --no-stress")
        if None in estimate.values():
            raise InputError(f"{result.path}: the estimate of the error isn't finite")
        norm = np.hypot(estimate["energy_norm"], estimate["error"])
        if norm > 0:
            largest = max(largest, estimate["relative"])
            of_cells = np.maximum(of_cells, of_step.cell_data["EnergyError"] / norm)
    return largest, of_cells**2


def errors_of(result: Result, quantity: str) -> tuple[float, Floats]:
    """The estimated error of a quantity relative to its value, and the size of the part of each cell, where the
    quantity is the first of the scene."""
    value, error = result.quantities[quantity], result.quantity_errors[quantity]
    if error is None or not value:
        without = result.report.get("without_derivatives") or "it has no estimate"
        why = without if error is None else "its value is 0"
        raise InputError(f"{result.path}: there is no error of quantity {quantity!r} to adapt to: {why}")
    return abs(error / value), np.abs(result.cell_data["QuantityError"] / value)


def sizes_for(result: Result, errors: Floats, aim: float, is_first: bool) -> SizeField:
    """The sizes with which the sum of the cells' `errors`, squares of the energy norm or parts of the error of a
    quantity, is about `aim`, with as few cells as can be.

    After Li and Bettess: with r the size after over that before, p the order, d the dimension, cells are Σ r^−d and
    their errors Σ e² r^2p = η²; the fewest cells have r^(2p+d) = μ/e². At a singularity, which shows on an
    adapted mesh, a cell's squared error falls like its size, whatever its order. Errors of a quantity are products of
    two of the energy norm, and fall as these squares do."""
    d = 3 if result.is_in_space else 2
    p = max(KINDS[cells.kind][1] for cells in result.cells)
    squares = np.maximum(errors, 1e-24 * errors.sum())
    q = 2 * p + d
    smooth = squares if is_first else np.minimum(squares, SINGULAR * squares.mean())
    mu = (aim / (smooth ** (d / q)).sum()) ** (q / (2 * p))
    ratio = np.clip((mu / smooth) ** (1 / q) * smooth / squares, LEAST, MOST)
    sizes = at_nodes(result, ratio)
    asked = SizeField([])
    for cells in result.cells:
        letter = KINDS[cells.kind][0]
        corners = cells.nodes[:, : CORNERS[letter]]
        asked.cells.append((letter, result.points[corners], sizes[corners]))
    return asked


def at_nodes(result: Result, ratio: Floats) -> Floats:
    """Sizes at nodes: means of the logarithms of the cells around, that grow along the mesh by GRADATION at most."""
    sums, counts = np.zeros(len(result.points)), np.zeros(len(result.points))
    ends: list[NDArray[np.int64]] = []
    for kind, members, nodes in result.cells:
        letter = KINDS[kind][0]
        edges = np.array([nodes[:, pair] for pair in EDGES[letter]])
        lengths = np.linalg.norm(result.points[edges[:, :, 0]] - result.points[edges[:, :, 1]], axis=2)
        size = np.log(lengths.mean(axis=0) * ratio[members])
        for corner in nodes[:, : CORNERS[letter]].T:
            np.add.at(sums, corner, size)
            np.add.at(counts, corner, 1)
        ends.append(edges.reshape(-1, 2))
    sizes = np.exp(sums / np.maximum(counts, 1))
    a, b = np.unique(np.sort(np.concatenate(ends), axis=1), axis=0).T
    growth = GRADATION * np.linalg.norm(result.points[a] - result.points[b], axis=1)
    while True:
        before = sizes.copy()
        np.minimum.at(sizes, a, before[b] + growth)
        np.minimum.at(sizes, b, before[a] + growth)
        if np.array_equal(sizes, before):
            return sizes
