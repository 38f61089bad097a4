"""Cells of a grid in VTKHDF."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

# How many nodes cells have, by VTK's number of their kind.
NODES = {5: 3, 22: 6, 9: 4, 23: 8, 28: 9, 10: 4, 24: 10, 12: 8, 25: 20, 29: 27}


class Cells(NamedTuple):
    """The cells of one kind."""

    kind: int
    """VTK's number."""
    members: NDArray[np.int64]
    """Places of the cells among all."""
    nodes: NDArray[np.int64]
    """Nodes of the cells, a row for each."""


def cells_of(grid: Any) -> list[Cells]:
    """Cells of every kind of an open grid, their nodes among all nodes of the file. Raises `ValueError` where they have
    other nodes than their kind, or some that aren't there."""
    types = grid["Types"][:]
    offsets, connectivity = grid["Offsets"][:], grid["Connectivity"][:]
    starts, ends, nodes = [], [], []
    at = {"point": 0, "cell": 0, "id": 0}
    sizes = (grid[f"NumberOf{name}"][:] for name in ("Points", "Cells", "ConnectivityIds"))
    for partition, (points, cells, ids) in enumerate(zip(*sizes, strict=True)):
        # Each partition has an offset more than cells.
        own = offsets[at["cell"] + partition :][: cells + 1] + at["id"]
        starts.append(own[:-1])
        ends.append(own[1:])
        nodes.append(connectivity[at["id"] :][:ids] + at["point"])
        at = {"point": at["point"] + points, "cell": at["cell"] + cells, "id": at["id"] + ids}
    first, last, of_cells = (np.concatenate(part) for part in (starts, ends, nodes))
    found = []
    for kind in np.unique(types):
        members = np.flatnonzero(types == kind)
        width = NODES.get(int(kind), 0)
        if width == 0 or (last[members] - first[members] != width).any():
            raise ValueError(f"there are cells of kind {kind} with other nodes than such have")
        found.append(Cells(int(kind), members, of_cells[first[members, None] + np.arange(width)]))
    if len(of_cells) and not 0 <= of_cells.min() <= of_cells.max() < len(grid["Points"]):
        raise ValueError("there are cells of nodes that aren't there")
    return found
