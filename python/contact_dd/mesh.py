"""Meshes from wherever they come, as files of Gmsh's."""

from __future__ import annotations

import tempfile
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from contact_dd.errors import InputError
from contact_dd.msh import Mesh, written

if TYPE_CHECKING:
    import meshio

MeshSource = Any
"""A file, its content in Gmsh's format, a mesh of meshio, or Gmsh's model."""

# Facets of meshio's cells by their corners, and the kind that a facet is.
FACETS: dict[str, tuple[str, list[tuple[int, ...]]]] = {
    "triangle": ("line", [(0, 1), (1, 2), (2, 0)]),
    "triangle6": ("line3", [(0, 1, 3), (1, 2, 4), (2, 0, 5)]),
    "quad": ("line", [(0, 1), (1, 2), (2, 3), (3, 0)]),
    "quad8": ("line3", [(0, 1, 4), (1, 2, 5), (2, 3, 6), (3, 0, 7)]),
    "quad9": ("line3", [(0, 1, 4), (1, 2, 5), (2, 3, 6), (3, 0, 7)]),
    "tetra": ("triangle", [(0, 2, 1), (0, 1, 3), (1, 2, 3), (0, 3, 2)]),
    "tetra10": ("triangle6", [(0, 2, 1, 6, 5, 4), (0, 1, 3, 4, 8, 7), (1, 2, 3, 5, 9, 8), (0, 3, 2, 7, 9, 6)]),
    "hexahedron": (
        "quad", [(0, 3, 2, 1), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7), (4, 5, 6, 7)],
    ),
    "hexahedron20": (
        "quad8",
        [
            (0, 3, 2, 1, 11, 10, 9, 8), (0, 1, 5, 4, 8, 17, 12, 16), (1, 2, 6, 5, 9, 18, 13, 17),
            (2, 3, 7, 6, 10, 19, 14, 18), (3, 0, 4, 7, 11, 16, 15, 19), (4, 5, 6, 7, 12, 13, 14, 15),
        ],
    ),
}
CORNERS = {"line": 2, "line3": 2, "triangle": 3, "triangle6": 3, "quad": 4, "quad8": 4}


def msh_of(source: MeshSource) -> bytes:
    """The content of a file of Gmsh's that holds the mesh with its named groups."""
    if isinstance(source, bytes):
        return source
    if isinstance(source, str | Path):
        return of_file(Path(source))
    if hasattr(source, "getPhysicalGroups") or hasattr(source, "model"):
        return of_gmsh()
    if hasattr(source, "points") and hasattr(source, "cells"):
        return written(of_meshio(source))
    raise InputError(
        f"a {type(source).__name__} is no mesh; expected the name of a file, a mesh of meshio, or Gmsh's model"
    )


def deck_of(source: MeshSource) -> Path | None:
    """The file of a deck of Abaqus or CalculiX, which the programs read themselves."""
    path = Path(source) if isinstance(source, str | Path) else None
    return path.resolve() if path and path.suffix.lower() == ".inp" else None


def of_file(path: Path) -> bytes:
    if path.suffix == ".msh":
        try:
            return path.read_bytes()
        except OSError as error:
            raise InputError(f"{path}: can't be read: {error.strerror}") from error
    if not path.exists():
        raise InputError(f"{path}: there is no such file")
    try:
        import meshio
    except ImportError as error:
        raise InputError(f"{path}: isn't a mesh of Gmsh's, .msh; the Python package meshio reads others") from error
    try:
        mesh = meshio.read(path)
    except (Exception, SystemExit) as error:
        # Its readers fail in any way where a file isn't as they expect.
        raise InputError(f"{path}: meshio can't read it: {error!r}") from error
    return written(of_meshio(mesh))


def of_gmsh() -> bytes:
    """Gmsh's current model, as a mesh of its physical groups."""
    import gmsh

    if not gmsh.model.getPhysicalGroups():
        raise InputError("Gmsh's model has no physical groups; bodies and sides need names")
    if len(gmsh.model.mesh.getElementTypes()) == 0:
        raise InputError("Gmsh's model has no mesh; gmsh.model.mesh.generate makes one")
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, "mesh.msh")
        gmsh.option.setNumber("Mesh.MshFileVersion", 4.1)
        gmsh.write(str(path))
        return path.read_bytes()


def of_meshio(source: meshio.Mesh) -> Mesh:
    """The mesh with its groups.

    Groups are cell sets; where there are none, every value of a cell's integer data is one, called by its name in
    `field_data`, else by that of the data and the value, "region 1". A point set is the group of the boundary's facets
    between its points, where there are any, else that of the points.
    """
    points = np.zeros((len(source.points), 3))
    points[:, : source.points.shape[1]] = source.points
    mesh = Mesh(points, [(block.type, np.asarray(block.data)) for block in source.cells])
    for name, of_blocks in source.cell_sets.items():
        if not name.startswith("gmsh:"):
            mesh.add_group(name, [np.asarray([] if of is None else of, dtype=int) for of in of_blocks])
    if not mesh.groups:
        names = {(int(value[1]), int(value[0])): name for name, value in source.field_data.items() if len(value) == 2}
        for data, of_blocks in source.cell_data.items():
            if data != "gmsh:geometrical" and all(np.issubdtype(np.asarray(of).dtype, np.integer) for of in of_blocks):
                add_values(mesh, data, of_blocks, names)
    for name, members in source.point_sets.items():
        add_point_set(mesh, name, np.asarray(members, dtype=int))
    if not mesh.groups:
        raise InputError("the mesh has no groups; expected cell sets, point sets or integers that tell cells apart")
    return mesh


def add_values(mesh: Mesh, data: str, of_blocks: list[NDArray[Any]], names: dict[tuple[int, int], str]) -> None:
    for value in np.unique(np.concatenate(of_blocks)):
        chosen = [np.flatnonzero(np.asarray(of) == value) for of in of_blocks]
        for dim in sorted({mesh.dim_of(k) for k, of in enumerate(chosen) if len(of)}):
            name = names.get((dim, int(value)), f"{data} {value}")
            mesh.add_group(name, [of if mesh.dim_of(k) == dim else of[:0] for k, of in enumerate(chosen)])


def add_point_set(mesh: Mesh, name: str, members: NDArray[Any]) -> None:
    is_member = np.zeros(len(mesh.points), dtype=bool)
    is_member[members] = True
    facets: dict[str, list[NDArray[Any]]] = {}
    for kind, nodes in boundary(mesh):
        chosen = nodes[is_member[nodes[:, : CORNERS[kind]]].all(axis=1)]
        if len(chosen):
            facets.setdefault(kind, []).append(chosen)
    blocks = [(kind, np.concatenate(of)) for kind, of in facets.items()] or [("vertex", members[:, None])]
    before = len(mesh.blocks)
    mesh.blocks.extend(blocks)
    mesh.add_group(name, [np.arange(len(nodes) if k >= before else 0) for k, (_, nodes) in enumerate(mesh.blocks)])


def boundary(mesh: Mesh) -> list[tuple[str, NDArray[Any]]]:
    """The facets of one cell only."""
    facets = [
        (kind, nodes[:, facet])
        for cell, nodes in mesh.blocks
        if cell in FACETS and mesh.dim_of_kind(cell) == mesh.dim
        for kind, places in [FACETS[cell]]
        for facet in places
    ]
    if not facets:
        return []
    keys = [np.sort(nodes[:, : CORNERS[kind]], axis=1) for kind, nodes in facets]
    padded = np.full((sum(map(len, keys)), 4), -1)
    at = 0
    for key in keys:
        padded[at : at + len(key), : key.shape[1]] = key
        at += len(key)
    _, inverse, count = np.unique(padded, axis=0, return_inverse=True, return_counts=True)
    is_outer = np.split(count[inverse.ravel()] == 1, np.cumsum([len(key) for key in keys])[:-1])
    return [(kind, nodes[of]) for (kind, nodes), of in zip(facets, is_outer, strict=True)]
