"""Supports and loads of pictures are those of the scenes."""

import matplotlib.pyplot as plt
import numpy as np
import pytest
from matplotlib.collections import PathCollection

from contact_dd import Model
from contact_dd.drawing import obstacle, symbols
from contact_dd.drawing.conditions import conditions_of
from contact_dd.drawing.contact import pressed_sides
from contact_dd.drawing.integrals import NODES, integrals, rule_of
from contact_dd.drawing.obstacle import draw_obstacles
from contact_dd.drawing.overview import overview
from contact_dd.drawing.plane import Plane
from contact_dd.drawing.space import Solid


def of_plane(result):
    outline = Plane(result).outline
    return conditions_of(result, np.unique(outline[outline >= 0]))


def test_loads_far_from_a_small_contact_are_drawn_in_a_panel_of_all_bodies(scene, tmp_path):
    result = Model.from_scene(scene("tunnel")).run(folder=tmp_path, progress=False)
    loaded = result.points[of_plane(result).nodes, :2]
    assert len(loaded) > 0
    whole, around, part, _ = overview(Plane(result), 1.0).axes
    for axes, has_loads in ((whole, True), (around, False), (part, False)):
        low, high = np.transpose([axes.get_xlim(), axes.get_ylim()])
        assert ((loaded >= low) & (loaded <= high)).all() == has_loads
    plt.close("all")


@pytest.mark.parametrize("kind", NODES)
def test_integrals_of_cells_are_exact(kind):
    nodes = np.array(NODES[kind], dtype=float)
    rule = rule_of(kind)
    assert np.allclose(rule.values.sum(axis=1), 1)
    assert np.allclose(rule.slopes.sum(axis=1), 0, atol=1e-12)
    # ∫ x^2 dV by hand: of a simplex 2!/(d + 2)!, of a square or a cube 1/3.
    dimension = nodes.shape[1]
    is_simplex = kind in (5, 22, 10, 24)
    expected = {(2, True): 1 / 12, (3, True): 1 / 60}.get((dimension, is_simplex), 1 / 3)
    assert np.allclose([rule.weights @ (rule.values @ nodes[:, k]) ** 2 for k in range(dimension)], expected)
    # A uniform stress does on each node what its tractions on the surface do: work by every uniform strain.
    corners = nodes @ (np.eye(dimension) + 0.1 * np.arange(dimension**2).reshape(dimension, dimension))
    found = integrals(kind, corners[None], np.tile(np.arange(1.0, 7.0), (1, len(nodes), 1)))
    stress = np.array([[1, 4, 6], [4, 2, 5], [6, 5, 3]])[:dimension, :dimension]
    assert np.allclose(np.einsum("ne,nf->ef", found.forces[0], corners), found.shares.sum() * stress)


def test_loads_in_space_are_those_of_the_scene(scene, tmp_path):
    result = Model.from_scene(scene("stack3d")).run(folder=tmp_path, progress=False)
    solid = Solid(result)
    conditions = solid.conditions
    # 1e6 (1 + 0.3 x − 0.2 y) on 2 × 2 m above, 25 kN/m³ in blocks of 4 × 4, 3 × 3, 2 × 2 × 1 m.
    assert np.allclose(conditions.forces.sum(axis=0), [0, 0, -4e6])
    assert np.allclose(result.points[conditions.nodes, 2], 3)
    weights = sorted(force[2] for _, force in conditions.bodies)
    assert np.allclose(weights, [-400e3, -225e3, -100e3])
    assert {len(support.axes) for support in conditions.supports} == {3}
    assert np.allclose(result.points[[support.node for support in conditions.supports], 2], 0)


def test_initial_stress_is_no_load(scene, tmp_path):
    result = Model.from_scene(scene("tunnel")).run(folder=tmp_path, progress=False)
    for step, right, above in ((1, 1e6, 2e6), (4, 0.5e6, 3e6)):
        of_step = result.at_step(step)
        conditions = of_plane(of_step)
        size = of_step.points.max(axis=0)
        assert np.allclose(conditions.forces.sum(axis=0), [-right * size[1], -above * size[0]])
        places = of_step.points[conditions.nodes]
        assert np.isclose(places[:, :2] / size[:2], 1).any(axis=1).all()
        assert conditions.bodies == []
        # Both axes of symmetry hold what is in the middle of the tunnel.
        for support in conditions.supports:
            x, y, _ = of_step.points[support.node]
            assert len(support.axes) == sum(np.isclose([x, y], 0))


def test_a_load_on_a_reference_point_is_there_and_its_coupling_presses_nothing(scene, tmp_path):
    model = Model.from_scene(scene("stack3d"))
    del model.scene["pressure"]
    model.coupling("loaded", [0.2, 0.0, 4.0], kind="rigid", force=[0, 0, -1e6])
    result = model.run(folder=tmp_path, progress=False)
    solid = Solid(result)
    assert np.allclose(result.points[solid.conditions.nodes], [[0.2, 0, 4]])
    assert np.allclose(solid.conditions.forces, [[0, 0, -1e6]])
    assert set(solid.pressed) == {"lower joint", "upper joint"}
    figure = result.plot()
    axes = figure.subfigs[0].axes[0]
    place = result.points[solid.conditions.nodes[0]] @ solid.raster().frame[:2].T
    assert axes.get_ylim()[0] < place[1] < axes.get_ylim()[1]
    plt.close("all")


def test_springs_are_supports_of_their_own(scene, tmp_path):
    model = Model.from_scene(scene("stack"))
    del model.scene["displacement"]
    model.spring("ground", stiffness=[0, 1e9])
    model.fix("loaded", x=0.0)
    conditions = of_plane(model.run(folder=tmp_path, progress=False))
    springs = [support for support in conditions.supports if support.is_spring]
    assert len(springs) > 3
    assert {tuple(map(tuple, np.abs(support.axes))) for support in springs} == {((0.0, 1.0),)}
    words = {entry.get_label() for entry in symbols.entries(conditions, 2)}
    assert words == {"spring", "roller, held along its axis", "load", "body force"}


def test_pictures_have_few_symbols_and_none_without_the_problem(scene, tmp_path):
    result = Model.from_scene(scene("stack")).run(folder=tmp_path, progress=False)
    figure = overview(Plane(result), 1.0)
    [legend] = figure.legends
    words = [text.get_text() for text in legend.get_texts()]
    assert {"fixed", "load", "body force"} <= set(words)
    counts = [len(one.get_offsets()) for one in figure.axes[0].collections if isinstance(one, PathCollection)]
    assert len(counts) == 3
    assert counts[-1] == 3
    assert all(2 < count <= symbols.MOST for count in counts)
    for path in tmp_path.glob("*.h5"):
        path.write_bytes(b"no problem")
    figure = overview(Plane(result), 1.0)
    assert not [one for one in figure.axes[0].collections if isinstance(one, PathCollection)]
    plt.close("all")


def test_arrows_of_a_uniform_load_have_one_length(scene, tmp_path):
    result = Model.from_scene(scene("patch", "--element", "triangle6")).run(folder=tmp_path, progress=False)
    plane, conditions = Plane(result), of_plane(result)
    # Two sides of 2 m.
    assert np.isclose(plane.lengths(conditions.nodes).sum(), 4)
    axes = plt.figure().add_subplot()
    paper = symbols.Paper(plane.points, plane.normals(), np.eye(2), plane.size, plane.lengths)
    symbols.draw_loads(axes, paper, conditions.nodes, conditions.forces)
    [arrows] = axes.collections
    lengths = [np.ptp(path.vertices, axis=0).max() for path in arrows.get_paths()]
    assert len(lengths) > 8
    # At the corner both loads have one arrow.
    assert np.isclose(lengths, symbols.LONGEST).sum() >= len(lengths) - 1
    plt.close("all")


def test_both_sides_of_a_cut_have_arrows():
    places = np.array([[x, y] for y in (0.0, 1e-3) for x in (0.0, 0.01)])
    forces = np.array([[0.0, -1.0], [0.0, -1.0], [0.0, 1.0], [0.0, 1.0]])
    axes = plt.figure().add_subplot()
    symbols.draw_loads(axes, symbols.Paper(places, np.zeros((4, 2)), np.eye(2), 1.0), np.arange(4), forces)
    [arrows] = axes.collections
    assert len(arrows.get_offsets()) == 2
    plt.close("all")


def test_an_obstacle_is_drawn_where_a_side_faces_no_body(scene, tmp_path):
    for name, has_obstacle in (("wall", True), ("patch", False)):
        result = Model.from_scene(scene(name)).run(folder=tmp_path, progress=False)
        plane = Plane(result)
        sides = pressed_sides(plane, plane.deformed(200.0))
        assert sum(side.is_on_obstacle for side in sides) == has_obstacle
        figure, axes = plt.subplots()
        draw_obstacles(axes, sides, 200.0, 1.0)
        assert bool(obstacle.entries(sides)) == has_obstacle
        if has_obstacle:
            # The ground sank by 4e-4 exp(−((x − 0.625)/0.25)²), which is enlarged like displacements.
            x, y = np.concatenate(axes.collections[1].get_segments()).T
            inside = (x > 0) & (x < 1.25)
            assert np.allclose(y[inside], -0.08 * np.exp(-(((x[inside] - 0.625) / 0.25) ** 2)), atol=2e-3)
    plt.close("all")


def test_symbols_are_spread_over_all_that_is_held():
    places = np.random.default_rng(3).random((3000, 2)) * [10, 1]
    paper = symbols.Paper(places, np.ones((3000, 2)), np.eye(2), 10.0)
    chosen = paper.spread(np.arange(3000))
    assert 8 <= len(chosen) <= symbols.MOST
    away = np.linalg.norm(places[:, None] - places[chosen], axis=2)
    # None is far from a symbol, and no two symbols are near each other.
    assert away.min(axis=1).max() < 1.5
    between = away[chosen]
    assert between[~np.eye(len(chosen), dtype=bool)].min() >= symbols.APART * 10


def test_an_arrow_that_pushes_ends_at_its_node():
    pushing, pulling = (symbols.arrow((0, -1), 20, ends_here).vertices for ends_here in (True, False))
    assert np.isclose(pushing[:, 1].min(), 0)
    assert np.isclose(pushing[:, 1].max(), 20)
    assert np.isclose(pulling[:, 1].max(), 0)
    assert np.isclose(pulling[:, 1].min(), -20)


def test_the_scale_is_below_arrows_that_end_at_the_lower_side(scene, tmp_path):
    plane = Plane(Model.from_scene(scene("hertz")).run(folder=tmp_path, progress=False))
    figure = overview(plane, 1.0)
    axes = figure.axes[0]
    figure.canvas.draw()
    (bar,) = (one for one in axes.artists if hasattr(one, "size_bar"))
    inch = figure.dpi_scale_trans.inverted()
    top = inch.transform(bar.size_bar.get_window_extent(figure.canvas.get_renderer()).corners())[:, 1].max()
    side = inch.transform(axes.transData.transform([[0, -2]]))[0, 1]
    # Arrows of the tractions of the half plane push up from below, 24 points long.
    conditions, low = of_plane(plane.result), plane.points[:, 1].min()
    pushes = conditions.forces[plane.points[conditions.nodes, 1] == low][:, 1]
    assert len(pushes) > 0
    assert pushes.max() > 0
    assert top < side - 24 / 72
    plt.close("all")
