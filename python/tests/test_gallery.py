"""Models written in Python have the numbers of the gallery."""

import numpy as np
from conftest import agrees_with_the_gallery

from contact_dd import Material, Model

GRANITE = Material(young=5.2e9, poisson=0.18)


def granite(path, **friction):
    model = Model.from_mesh(path.with_name("mesh.msh"), "strain", title="Loaded granite block with cracks")
    model.body("block", GRANITE)
    model.fix("bottom")
    model.load(["lower right", "upper left"], pressure=0.6e7)
    model.load("top", pressure="3e6")
    for side in "left", "right":
        sides = f"{side} crack lower", f"{side} crack upper"
        model.contact(*sides, name=f"{side} crack", gap=0.0, **friction)
    return model


def test_granite(scene):
    path = scene("granite", "--refine", "1")
    result = granite(path).run(ranks=2, subdomains=8, progress=False)
    agrees_with_the_gallery(result, "granite")
    assert result.report["ranks"] == 2
    assert [int((table["status"] == 1).sum()) for table in result.contacts.values()] == [15, 48]
    assert np.linalg.norm(result.displacement, axis=1).max().round(7) == 1.18486e-2
    assert len(result.points) == len(np.unique(result.nodes)) == result.report["dofs"] / 2


def test_granite_with_friction(scene):
    result = granite(scene("granite"), friction=0.6).run(progress=False, subdomains=8)
    agrees_with_the_gallery(result, "granite-friction")
    for table in result.contacts.values():
        shear = np.linalg.norm(table["tangential_force"], axis=1)
        assert (shear <= 0.6 * table["force"] * (1 + 1e-9)).all()


def test_hertz_on_one_rank(scene):
    path = scene("hertz", "--element", "quad8")
    agrees_with_the_gallery(Model.from_scene(path).run(ranks=1, progress=False), "hertz")


def test_a_stack_in_space(scene):
    result = Model.from_scene(scene("stack3d", "--element", "hexahedron27")).run(progress=False)
    agrees_with_the_gallery(result, "stack3d")
    assert result.is_in_space
