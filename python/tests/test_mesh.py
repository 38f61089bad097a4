"""A mesh is the same, wherever it comes from."""

import gmsh
import meshio
import numpy as np
import pytest

from contact_dd import InputError, Material, Model
from contact_dd.mesh import msh_of


@pytest.fixture
def blocks(tmp_path):
    """Two blocks, one upon the other, as Gmsh's model and as a file."""
    gmsh.initialize()
    gmsh.option.setNumber("General.Terminal", 0)
    rectangles = [gmsh.model.occ.addRectangle(0, y, 0, 2, 1) for y in (0, 1)]
    gmsh.model.occ.synchronize()
    for name, tag in zip(("lower", "upper"), rectangles, strict=True):
        gmsh.model.addPhysicalGroup(2, [tag], name=name)
    for name, tags in {"bottom": [1], "above": [3], "below": [5], "top": [7], "sides": [2, 4, 6, 8]}.items():
        gmsh.model.addPhysicalGroup(1, tags, name=name)
    gmsh.option.setNumber("Mesh.MeshSizeMax", 0.25)
    gmsh.model.mesh.generate(2)
    gmsh.model.mesh.setOrder(2)
    yield tmp_path / "blocks.msh"
    gmsh.finalize()


def solved(mesh, names=str):
    model = Model.from_mesh(mesh, "strain")
    for body in "lower", "upper":
        model.body(names(body), Material(young=1e9, poisson=0.25))
    model.fix(names("bottom"))
    model.fix(names("sides"), x=0)
    model.load(names("top"), pressure="1e6*(1 + x)")
    model.contact(names("below"), names("above"), name="joint")
    return model.run(ranks=1, progress=False)


def same(one, other):
    assert np.array_equal(np.sort(one.contacts["joint"]["pressure"]), np.sort(other.contacts["joint"]["pressure"]))
    assert np.array_equal(one.points, other.points)
    assert np.array_equal(one.displacement, other.displacement)


def test_a_model_of_gmsh_is_its_file(blocks):
    of_model = solved(gmsh.model)
    gmsh.write(str(blocks))
    same(of_model, solved(blocks))


def test_a_mesh_of_meshio_is_its_file(blocks):
    gmsh.write(str(blocks))
    mesh = meshio.read(blocks)
    same(solved(blocks), solved(mesh))
    # A cell in two groups is one cell.
    mesh.cell_sets["all"] = [np.arange(len(block.data)) for block in mesh.cells]
    same(solved(blocks), solved(mesh))


@pytest.mark.parametrize("ending", ["vtu", "xdmf"])
def test_integers_tell_cells_apart_in_files_without_names(blocks, ending):
    if ending == "xdmf":
        # Of several kinds of cells meshio reads linear ones alone.
        gmsh.model.mesh.setOrder(1)
    gmsh.write(str(blocks))
    mesh = meshio.read(blocks)
    physical = {name: value[0] for name, value in mesh.field_data.items()}
    path = blocks.with_suffix("." + ending)
    cell_data = {"region": mesh.cell_data["gmsh:physical"]}
    meshio.write(path, meshio.Mesh(mesh.points, mesh.cells, cell_data=cell_data))
    result = solved(path, lambda name: f"region {physical[name]}")
    known = solved(blocks)
    assert np.allclose(result.displacement, known.displacement, rtol=0, atol=1e-12 * abs(known.displacement).max())


def test_sets_of_a_deck_of_abaqus_are_groups(blocks):
    """Sides are what lies between the nodes of an NSET, bodies are ELSETs."""
    gmsh.write(str(blocks))
    known = solved(blocks)
    at = known.points
    bodies = {"lower": at[:, 1] < 1, "upper": at[:, 1] > 1}
    lines = ["*NODE"]
    lines += [f"{tag}, {x:.17g}, {y:.17g}, {z:.17g}" for tag, (x, y, z) in zip(known.nodes, at, strict=True)]
    (cells,) = known.cells
    for body, inside in bodies.items():
        lines.append(f"*ELEMENT, TYPE=CPE6, ELSET={body}")
        own = np.flatnonzero(inside[cells.nodes].any(axis=1))
        lines += [", ".join(map(str, [k + 1, *known.nodes[cells.nodes[k]]])) for k in own]
    below = np.isin(known.nodes, known.nodes[cells.nodes[inside[cells.nodes].any(axis=1)]])
    for name, chosen in {
        "bottom": at[:, 1] == 0, "top": at[:, 1] == 2, "sides": (at[:, 0] == 0) | (at[:, 0] == 2),
        "above": (at[:, 1] == 1) & ~below, "below": (at[:, 1] == 1) & below,
    }.items():
        lines += [f"*NSET, NSET={name}", *(f"{tag}," for tag in known.nodes[chosen])]
    deck = blocks.with_suffix(".INP")
    deck.write_text("*INCLUDE, INPUT=mesh.txt\n")
    (deck.parent / "mesh.txt").write_text("\n".join(lines) + "\n")
    same(solved(deck), known)


@pytest.mark.parametrize(("recombine", "order", "incomplete"), [(0, 2, 0), (1, 1, 0), (1, 2, 1), (1, 2, 0)])
def test_nodes_of_volumes_keep_their_places(tmp_path, recombine, order, incomplete):
    """Gmsh reads what was written with every node where it was, on edges, faces and inside."""
    gmsh.initialize()
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        gmsh.option.setNumber("Mesh.SecondOrderIncomplete", incomplete)
        base = gmsh.model.occ.addRectangle(0, 0, 0, 1, 1)
        gmsh.model.occ.extrude([(2, base)], 0, 0, 1, numElements=[2], recombine=bool(recombine))
        gmsh.model.occ.synchronize()
        gmsh.model.addPhysicalGroup(3, [1], name="block")
        gmsh.model.addPhysicalGroup(2, [1], name="bottom")
        for curve in gmsh.model.getEntities(1):
            gmsh.model.mesh.setTransfiniteCurve(curve[1], 3)
        gmsh.model.mesh.setTransfiniteSurface(base)
        if recombine:
            gmsh.model.mesh.setRecombine(2, base)
        gmsh.model.mesh.generate(3)
        gmsh.model.mesh.setOrder(order)
        path = tmp_path / "block.msh"
        gmsh.write(str(path))

        def places():
            kinds, _, nodes = gmsh.model.mesh.getElements(3)
            tags, at, _ = gmsh.model.mesh.getNodes()
            points = np.zeros((int(tags.max()) + 1, 3))
            points[tags.astype(int)] = at.reshape(-1, 3)
            width = gmsh.model.mesh.getElementProperties(kinds[0])[3]
            return kinds, points[nodes[0].astype(int).reshape(-1, width)]

        gmsh.clear()
        gmsh.open(str(path))
        kinds, expected = places()
        path.write_bytes(msh_of(meshio.read(path)))
        gmsh.clear()
        gmsh.open(str(path))
        again, found = places()
        assert list(again) == list(kinds)
        order = [np.lexsort(cells.mean(axis=1).T.round(9)) for cells in (expected, found)]
        assert np.allclose(expected[order[0]], found[order[1]], atol=1e-12)
        assert len(gmsh.model.getPhysicalGroups(2)) == 1
    finally:
        gmsh.finalize()


def test_what_is_no_mesh_is_refused(tmp_path):
    with pytest.raises(InputError, match="a dict is no mesh"):
        Model.from_mesh({})
    with pytest.raises(InputError, match=r"nowhere\.msh: can't be read"):
        Model.from_mesh("nowhere.msh")
    points = np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]])
    with pytest.raises(InputError, match="the mesh has no groups"):
        Model.from_mesh(meshio.Mesh(points, [("triangle", [[0, 1, 2]])]))
    with pytest.raises(InputError, match="cells of the kind 'wedge'"):
        Model.from_mesh(meshio.Mesh(np.zeros((6, 3)), [("wedge", [[0, 1, 2, 3, 4, 5]])]))
