"""Ties and equations, as a user gives them."""

import meshio
import numpy as np
import pytest

from contact_dd import InputError, Material, Model


def two_squares():
    """Two squares on each other, of three and of four cells a side."""
    points, cells, sides = [], [], {}
    for name, low, count in [("lower", 0.0, 3), ("upper", 1.0, 4)]:
        first = len(points)
        grid = np.arange((count + 1) ** 2).reshape(count + 1, count + 1) + first
        points += [[i / count, low + j / count] for j in range(count + 1) for i in range(count + 1)]
        cells.append(np.stack([grid[:-1, :-1], grid[:-1, 1:], grid[1:, 1:], grid[1:, :-1]], -1).reshape(-1, 4))
        for side, nodes in [("bottom", grid[0]), ("top", grid[-1]), ("left", grid[:, 0])]:
            sides[f"{name} {side}"] = np.stack([nodes[:-1], nodes[1:]], -1)
    blocks = [("quad", cells[0]), ("quad", cells[1]), *(("line", lines) for lines in sides.values())]
    names = ["lower", "upper", *sides]
    sets = {name: [np.arange(len(block[1])) if other == name else np.array([], int)
                   for other, block in zip(names, blocks, strict=True)] for name in names}
    return meshio.Mesh(np.array(points), blocks, cell_sets=sets)


def pulled():
    model = Model.from_mesh(two_squares(), plane="strain")
    for body in ("lower", "upper"):
        model.body(body, Material(young=200e9, poisson=0.0))
    model.fix("lower bottom")
    model.load("upper top", traction=[0.0, 2e6])
    return model


def test_tied_squares_are_pulled_as_one():
    model = pulled()
    model.tie("upper bottom", "lower top", name="weld", tolerance=1e-3)
    result = model.run(progress=False)
    expected = 2e6 / 200e9 * result.points[:, 1]
    np.testing.assert_allclose(result.displacement[:, 1], expected, atol=1e-12 * expected.max())
    weld = result.contacts["weld"]
    assert (weld["status"] == 1).all()
    assert (weld["force"] < 0.0).all()
    assert weld["force"].sum() == pytest.approx(-2e6)
    assert result.report["contacts"][0]["kind"] == "tie"


def test_an_equation_moves_a_side_as_another_one():
    model = pulled()
    model.fix("upper bottom", y=0.0)
    model.equation(("upper left", "x", 1.0), ("lower top", "x", -1.0), name="lever", value=1e-6)
    result = model.run(progress=False)

    def mean(is_there):
        return result.displacement[is_there, 0].mean()

    x, y = result.points[:, 0], result.points[:, 1]
    # Both bodies have nodes at y = 1.
    lower = result.nodes <= 16
    left, top = mean(~lower & (x < 1e-9)), mean(lower & (y > 1 - 1e-9))
    assert left - top == pytest.approx(1e-6, rel=1e-9)
    assert result.contacts["lever"]["force"].shape == (1,)


def test_messages_name_the_call():
    model = pulled()
    model.tie("upper bottom", "nowhere")
    with pytest.raises(InputError, match="tie 'upper bottom on nowhere': the mesh has no physical group 'nowhere'"):
        model.run(progress=False)
    model = pulled()
    model.equation(("upper top", "z", 1.0))
    with pytest.raises(InputError, match=r"equation\(\('upper top', 'z', 1.0\)\).*a plane scene has no 'z'"):
        model.run(progress=False)


def bar():
    """Two squares that share their nodes at y = 1, one on the other, between two walls."""
    points = np.array([[x, y, 0.0] for y in range(3) for x in range(2)])
    blocks = [("quad", np.array([[0, 1, 3, 2], [2, 3, 5, 4]]))]
    blocks += [("line", np.array([line])) for line in ([0, 1], [2, 3], [5, 4])]
    names = ["bar", "foot", "cut", "top"]
    sets = {name: [np.arange(len(block[1])) if other == name else np.array([], int)
                   for other, block in zip(names, blocks, strict=True)] for name in names}
    model = Model.from_mesh(meshio.Mesh(points, blocks, cell_sets=sets), plane="strain")
    model.body("bar", Material(young=200e9, poisson=0.0))
    model.fix(["foot", "top"])
    return model


def test_a_bolt_is_tightened_and_locked():
    model = bar()
    model.pretension("cut", name="bolt", force=2e6)
    model.steps({}, {"pretension": {"bolt": {"lock": True}}})
    result = model.run(progress=False)
    first, second = (step["pretensions"][0] for step in result.report["steps"])
    assert first["force"] == pytest.approx(2e6)
    assert first["shortening"] == pytest.approx(2e6 * 2.0 / 200e9)
    assert (first["held"], second["held"]) == (False, True)
    assert second["shortening"] == pytest.approx(first["shortening"])


def test_a_quarter_of_a_square_does_what_the_others_do():
    points = np.array([[x, y, 0.0] for y in range(2) for x in range(2)])
    blocks = [("quad", np.array([[0, 1, 3, 2]])), ("line", np.array([[0, 1]])), ("line", np.array([[2, 0]])),
              ("line", np.array([[1, 3], [3, 2]]))]
    names = ["quarter", "side", "next side", "outside"]
    sets = {name: [np.arange(len(block[1])) if other == name else np.array([], int)
                   for other, block in zip(names, blocks, strict=True)] for name in names}
    model = Model.from_mesh(meshio.Mesh(points, blocks, cell_sets=sets), plane="strain")
    model.body("quarter", Material(young=200e9, poisson=0.3))
    model.spring("outside", normal=1e12, tangential=1e12)
    model.load("outside", traction=["-1e6*y", "1e6*x"])
    model.cyclic("side", "next side", [0.0, 0.0], 4)
    result = model.run(progress=False)
    u = {(round(x), round(y)): moved for (x, y, _), moved in zip(result.points, result.displacement, strict=True)}
    np.testing.assert_allclose(u[0, 1][:2], [-u[1, 0][1], u[1, 0][0]], atol=1e-10 * abs(u[1, 0]).max())
    assert u[1, 0][1] > 0.0


def test_a_spring_between_sides_carries_the_load():
    model = pulled()
    model.fix("upper left", x=0.0)
    model.spring_between("upper bottom", "lower top", stiffness=[0.0, 4e9], name="suspension")
    with pytest.warns(UserWarning, match="touch without a contact"):
        result = model.run(progress=False)
    [spring] = result.report["contacts"]
    assert spring["kind"] == "spring"
    np.testing.assert_allclose(spring["force"], [0, -2e6, 0], atol=1e-3)
    lower = result.nodes <= 16
    in_joint = result.points[:, 1] == 1.0
    above, below = (result.displacement[there & in_joint, 1].mean() for there in (~lower, lower))
    assert above - below == pytest.approx(2e6 / 4e9)


def test_a_side_that_follows_along_its_normal_slides():
    model = Model.from_mesh(two_squares(), plane="strain")
    for body in ("lower", "upper"):
        model.body(body, Material(young=200e9, poisson=0.3))
    model.tie("upper bottom", "lower top", name="weld", tolerance=1e-3)
    model.fix("lower bottom", y=0.0)
    model.fix(["lower left", "upper left"], x=0.0)
    model.coupling("upper top", [0.5, 2.5], directions=[[0.0, 1.0]], force=[0.0, 2e6])
    result = model.run(progress=False)
    # Plane strain: what is free to contract does so by ν/(1 − ν) of its stretch.
    stretch = 2e6 * (1 - 0.3**2) / 200e9
    # The nodes of the reference point come last.
    x, y = result.points[:-2, 0], result.points[:-2, 1]
    expected = np.stack([-0.3 / 0.7 * stretch * x, stretch * y], axis=1)
    np.testing.assert_allclose(result.displacement[:-2, :2], expected, atol=1e-9 * stretch)
