"""A geometry that Gmsh meshes again and again."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np

from contact_dd.errors import InputError
from contact_dd.mesh import of_gmsh
from contact_dd.sizes import SizeField


def meshed(path: Path | None, sizes: SizeField | None) -> bytes:
    """A mesh of a file of Gmsh's, or of its current model, with quadratic cells: of the sizes that the geometry itself
    asks for, or those given. A script that makes its mesh itself is run as it is, with the sizes set before."""
    if path is not None and not path.exists():
        raise InputError(f"{path}: there is no such file; expected the geometry, to mesh it again")
    with model_of(path) as gmsh:
        view = set_sizes(gmsh, sizes)
        if path is not None:
            try:
                gmsh.merge(str(path))
            except Exception as error:
                raise InputError(f"{path}: Gmsh can't read it: {error}") from error
        else:
            gmsh.model.mesh.clear()
        if len(gmsh.model.mesh.getElementTypes()) == 0:
            generate(gmsh, view)
        found = of_gmsh()
        if view is not None:
            gmsh.view.remove(view[0])
            gmsh.model.mesh.field.remove(view[1])
        return found


@contextmanager
def model_of(path: Path | None) -> Iterator[Any]:
    """Gmsh with a separate model for a file; the caller's models stay."""
    try:
        import gmsh
    except ImportError as error:
        raise InputError("meshing again takes the Python package gmsh") from error
    is_running = bool(gmsh.isInitialized())
    if path is None:
        if not is_running:
            raise InputError("there is no model of Gmsh's to mesh again; expected one, or the file of a geometry")
        yield gmsh
        return
    if not is_running:
        gmsh.initialize(interruptible=False)
        gmsh.option.setNumber("General.Terminal", 0)
    before = gmsh.model.getCurrent()
    gmsh.model.add("contact-dd")
    try:
        yield gmsh
    finally:
        if is_running:
            gmsh.model.remove()
            gmsh.model.setCurrent(before)
        else:
            gmsh.finalize()


def set_sizes(gmsh: Any, sizes: SizeField | None) -> tuple[int, int] | None:
    """Makes sizes those of the next mesh, and nothing else; returns the numbers of view and field."""
    if sizes is None:
        return None
    view = gmsh.view.add("sizes")
    for letter, corners, values in sizes.cells:
        rows = np.concatenate([corners[:, :, k] for k in range(3)] + [values], axis=1)
        gmsh.view.addListData(view, "S" + letter, len(rows), rows.ravel())
    field = gmsh.model.mesh.field.add("PostView")
    gmsh.model.mesh.field.setNumber(field, "ViewTag", view)
    use(gmsh, field)
    return view, field


def use(gmsh: Any, field: int) -> None:
    gmsh.model.mesh.field.setAsBackgroundMesh(field)
    for name in ("FromPoints", "FromCurvature", "ExtendFromBoundary"):
        gmsh.option.setNumber(f"Mesh.MeshSize{name}", 0)


def generate(gmsh: Any, view: tuple[int, int] | None) -> None:
    """Makes a mesh of quadratic cells, of linear ones where curved cells would overlap themselves."""
    if view is not None:
        # The geometry may have set sizes of its own.
        use(gmsh, view[1])
    gmsh.model.mesh.generate(gmsh.model.getDimension())
    gmsh.model.mesh.setOrder(2)
    _, cells, _ = gmsh.model.mesh.getElements(gmsh.model.getDimension())
    if gmsh.model.mesh.getElementQualities(np.concatenate(cells), "minSJ").min() <= 0:
        gmsh.model.mesh.setOrder(1)
