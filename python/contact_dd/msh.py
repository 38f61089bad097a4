"""Gmsh's format MSH 4.1."""

from __future__ import annotations

import io
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from contact_dd.errors import InputError

# Of meshio's kinds: dimension, Gmsh's number, and the order of nodes in Gmsh where it is another one.
KINDS: dict[str, tuple[int, int, list[int] | None]] = {
    "vertex": (0, 15, None),
    "line": (1, 1, None),
    "line3": (1, 8, None),
    "triangle": (2, 2, None),
    "triangle6": (2, 9, None),
    "quad": (2, 3, None),
    "quad8": (2, 16, None),
    "quad9": (2, 10, None),
    "tetra": (3, 4, None),
    "tetra10": (3, 11, [*range(8), 9, 8]),
    "hexahedron": (3, 5, None),
    "hexahedron20": (3, 17, [*range(8), 8, 11, 16, 9, 17, 10, 18, 19, 12, 15, 13, 14]),
    "hexahedron27": (
        3, 12, [*range(8), 8, 11, 16, 9, 17, 10, 18, 19, 12, 15, 13, 14, 24, 22, 20, 21, 23, 25, 26],
    ),
}


@dataclass
class Mesh:
    """Points, blocks of cells of one kind each, and named groups of cells of one dimension each."""

    points: NDArray[np.float64]
    blocks: list[tuple[str, NDArray[Any]]]
    groups: dict[tuple[int, str], list[NDArray[Any]]] = field(default_factory=dict)
    """By dimension and name: of each block the rows that belong to it."""

    def __post_init__(self) -> None:
        for kind, _ in self.blocks:
            if kind not in KINDS:
                raise InputError(f"the mesh has cells of the kind {kind!r}; expected {', '.join(KINDS)}")

    @property
    def dim(self) -> int:
        return max((self.dim_of_kind(kind) for kind, _ in self.blocks), default=0)

    @staticmethod
    def dim_of_kind(kind: str) -> int:
        return KINDS[kind][0]

    def dim_of(self, block: int) -> int:
        return self.dim_of_kind(self.blocks[block][0])

    def add_group(self, name: str, rows: list[NDArray[Any]]) -> None:
        """Adds a group of cells, rows of each block; those of another dimension than the highest are left out."""
        dims = [self.dim_of(k) for k, of in enumerate(rows) if len(of)]
        if not dims:
            return
        if '"' in name or "\n" in name:
            raise InputError(f"the group {name!r} has a quotation mark or a line break in its name")
        self.groups[max(dims), name] = [
            of if len(of) and self.dim_of(k) == max(dims) else np.zeros(0, dtype=int) for k, of in enumerate(rows)
        ]

    def entities(self) -> list[tuple[int, tuple[int, ...], str, NDArray[Any]]]:
        """Cells of a block that are in the same groups: dimension, numbers of the groups, kind, nodes."""
        found = []
        for block, (kind, nodes) in enumerate(self.blocks):
            belongs = np.zeros((len(nodes), len(self.groups)), dtype=bool)
            for number, rows in enumerate(self.groups.values()):
                if block < len(rows):
                    belongs[rows[block], number] = True
            sets, of = np.unique(belongs, axis=0, return_inverse=True)
            for place, members in enumerate(sets):
                if members.any():
                    numbers = tuple(int(number) + 1 for number in np.flatnonzero(members))
                    found.append((self.dim_of_kind(kind), numbers, kind, nodes[of.ravel() == place]))
        return sorted(found, key=lambda entity: entity[0])


def written(mesh: Mesh) -> bytes:
    """The mesh as MSH 4.1, ASCII; cells in no group are left out. Nodes have their numbers, from 1, as tags."""
    out = io.StringIO()
    entities = mesh.entities()
    out.write("$MeshFormat\n4.1 0 8\n$EndMeshFormat\n")
    out.write(f"$PhysicalNames\n{len(mesh.groups)}\n")
    for number, (dim, name) in enumerate(mesh.groups):
        out.write(f'{dim} {number + 1} "{name}"\n')
    out.write("$EndPhysicalNames\n$Entities\n")
    out.write(" ".join(str(sum(entity[0] == dim for entity in entities)) for dim in range(4)) + "\n")
    for tag, (dim, numbers, _, _) in enumerate(entities, 1):
        box = "0 0 0" if dim == 0 else "0 0 0 0 0 0"
        listed = " ".join(str(number) for number in (len(numbers), *numbers))
        out.write(f"{tag} {box} {listed}{' 0' if dim else ''}\n")
    count = len(mesh.points)
    out.write(f"$EndEntities\n$Nodes\n1 {count} 1 {count}\n{mesh.dim} {len(entities)} 0 {count}\n")
    np.savetxt(out, np.arange(1, count + 1), "%d")
    np.savetxt(out, mesh.points, "%.17g")
    total = sum(len(nodes) for *_, nodes in entities)
    out.write(f"$EndNodes\n$Elements\n{len(entities)} {total} 1 {total}\n")
    first = 1
    for tag, (dim, _, kind, nodes) in enumerate(entities, 1):
        _, code, order = KINDS[kind]
        out.write(f"{dim} {tag} {code} {len(nodes)}\n")
        ordered = nodes if order is None else nodes[:, order]
        np.savetxt(out, np.column_stack([np.arange(first, first + len(nodes)), ordered + 1]), "%d")
        first += len(nodes)
    out.write("$EndElements\n")
    return out.getvalue().encode()
