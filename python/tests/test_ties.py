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
