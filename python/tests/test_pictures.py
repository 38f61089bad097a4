"""Contents of pictures."""

import re

import matplotlib.pyplot as plt
import numpy as np
import pytest
from matplotlib.patches import Circle

from contact_dd import Model
from contact_dd.drawing import page as pages
from contact_dd.drawing import space
from contact_dd.drawing.chart import Chart, chart_of
from contact_dd.drawing.pressure_map import triangulation
from contact_dd.drawing.raster import Camera, Raster, edges_of
from contact_dd.drawing.surface import HEXAHEDRON
from contact_dd.drawing.units import units_of
from contact_dd.errors import InputError

RADIUS, AROUND, HEIGHTS = 3.0, 24, np.linspace(0, 4, 5)
LOADED = 2 * np.pi * 4 / AROUND
KIND = [("position", float, 3), ("normal", float, 3), ("pressure", float)]


def turned(axis_to):
    """A rotation that takes z to a direction."""
    third = np.array(axis_to) / np.linalg.norm(axis_to)
    first = np.cross(third, [0.3, 0.9, -0.2])
    first /= np.linalg.norm(first)
    return np.stack([first, np.cross(third, first), third], axis=1)


def cylinder(rotation, inward):
    angle, height = (grid.ravel() for grid in np.meshgrid(2 * np.pi * np.arange(AROUND) / AROUND, HEIGHTS))
    table = np.zeros(len(angle), KIND)
    out = np.stack([np.cos(angle), np.sin(angle), 0 * angle], axis=1)
    table["position"] = (RADIUS * out + height[:, None] * [0, 0, 1]) @ rotation.T + [5, -7, 2]
    table["normal"] = (-out if inward else out) @ rotation.T
    table["pressure"] = np.maximum(np.cos(angle - LOADED), 0) ** 2
    return table, angle, height


@pytest.mark.parametrize("inward", [False, True])
@pytest.mark.parametrize("axis", [(0, 0, 1), (1, 2, -3)])
def test_a_closed_cylinder_is_unrolled(axis, inward):
    table, angle, height = cylinder(turned(axis), inward)
    chart = chart_of(table)
    assert len(chart.rows) == len(table)
    # By the arc length, the same way around for all, cut opposite of the load, and the place along the axis.
    way = np.remainder(angle - LOADED + np.pi + 1e-9, 2 * np.pi) - np.pi - 1e-9
    arc = chart.x - chart.x[way == 0][0] if (way == 0).any() else chart.x - chart.x[np.abs(way).argmin()]
    sign = np.sign((way * arc).sum())
    is_opposite = np.isclose(way, -np.pi)
    assert np.allclose(arc, np.where(is_opposite, RADIUS * np.pi, sign * RADIUS * way))
    assert np.isclose(chart.radius, RADIUS)
    assert np.allclose(np.abs(np.subtract.outer(chart.y, chart.y)), np.abs(np.subtract.outer(height, height)))
    # Angles begin at the axis of coordinates nearest to the load, at 60° around z, else at the load.
    loaded = chart.x[np.abs(way).argmin()] / RADIUS
    if axis == (0, 0, 1):
        [(sign, name)] = re.findall(r"^angle from (−?)([xy]) about z$", chart.labels[0].name)
        begin = (-1) ** bool(sign) * np.eye(3)["xy".index(name)]
        at_zero = table["position"] - [5, -7, 2]
        assert abs(loaded) <= np.pi / 4 + 1e-9
        assert np.allclose(at_zero @ begin, RADIUS * np.cos(chart.x / RADIUS))
    else:
        assert chart.labels[0].with_unit("°") == "angle from the load [°]"
        assert abs(loaded) < 1e-9
    of_axis = "z [m]" if axis == (0, 0, 1) else "distance along the contact [m]\ndirection (-0.27, -0.53, 0.8)"
    assert chart.labels[1].with_unit("m") == of_axis


def test_a_closed_ball_is_seen_from_where_it_is_loaded():
    normals = np.random.default_rng(1).normal(size=(400, 3))
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    table = np.zeros(400, KIND)
    table["position"], table["normal"] = 2 * normals, normals
    table["pressure"] = np.maximum(normals[:, 0] - 0.8, 0)
    chart = chart_of(table)
    assert set(np.flatnonzero(table["pressure"])) <= set(chart.rows)
    assert (normals[chart.rows, 0] > 0).all()
    places = table["position"][chart.rows]
    assert np.allclose(np.hypot(chart.x, chart.y), np.hypot(places[:, 1], places[:, 2]), atol=0.2)


def test_a_flat_side_is_seen_along_its_normal(scene, tmp_path):
    result = Model.from_scene(scene("stack3d")).run(folder=tmp_path, progress=False)
    for table in result.contacts.values():
        chart = chart_of(table)
        apart = table["position"][:, None] - table["position"]
        on_paper = np.hypot(np.subtract.outer(chart.x, chart.x), np.subtract.outer(chart.y, chart.y))
        assert np.allclose(on_paper, np.linalg.norm(apart, axis=2))
        assert sorted(label.name.strip("−") for label in chart.labels) == ["x", "y"]


def test_what_doesnt_press_hides_nothing_and_axes_have_names(scene, tmp_path):
    result = Model.from_scene(scene("pin")).run(folder=tmp_path, progress=False)
    figure = space.PICTURES["pressure"](result, None)
    [picture] = figure.axes[0].images
    # What presses is darker than edges are; where nothing presses there is white, and there are edges.
    coloured = picture.get_array()[..., :3]
    saturation = np.ptp(coloured, axis=2)
    assert 0.002 < (saturation > 0.2).mean() < 0.1
    assert (coloured.min(axis=2) > 0.999).mean() > 0.7
    overview = space.overview(result, None)
    labels = [axes.get_xlabel() for figure in overview.subfigs for axes in figure.axes]
    # Every contact has its map.
    assert [label for label in labels if label] == ["angle from x about z [°]", "angle from −x about z [°]"]
    assert "z [mm]" in [axes.get_ylabel() for figure in overview.subfigs for axes in figure.axes]
    # Both lie within the bodies, where glass shows them by their names.
    [glass] = [axes for axes in overview.subfigs[0].axes if axes.get_title().startswith("Contacts within")]
    assert {text.get_text() for text in glass.texts} == {"fork", "hole"}
    plt.close("all")


def test_a_circle_is_drawn_on_pressures_in_space_alone(scene, tmp_path):
    result = Model.from_scene(scene("sphere")).run(folder=tmp_path, progress=False)
    overview = space.overview(result, None, 0.8149)
    [circle] = overview.findobj(Circle)
    assert circle.get_radius() == 0.8149
    assert circle.get_label() == "a = 0.8149 m"
    # What presses is a small part of the ball, which isn't looked through.
    assert not [axes for axes in overview.subfigs[0].axes if axes.get_title().startswith("Contacts within")]
    plt.close("all")
    with pytest.raises(InputError, match="in the plane"):
        Model.from_scene(scene("patch")).run(folder=tmp_path, progress=False).plot(circle=1.0)


def square(corner, size, height):
    """A face with its middles, and the points of it."""
    s = np.array([(0, 0), (0.5, 0), (1, 0), (1, 0.5), (1, 1), (0.5, 1), (0, 1), (0, 0.5)])
    return np.column_stack([corner + size * s, np.full(8, height)])


def test_what_is_nearer_to_the_eye_hides_the_rest_and_values_vary_within_faces():
    # A large face with values from 0 to 1 along x, a small one above its middle, seen from above.
    points = np.concatenate([square([0, 0], 4.0, 0.0), square([1, 1], 2.0, 1.0)])
    faces = [np.arange(8), np.arange(8, 16)]
    values = np.concatenate([points[:8, 0] / 4, np.full(8, 3.0)])
    camera = Camera(90, -90)
    assert np.allclose(camera.axes(), np.eye(3), atol=1e-12)
    raster = Raster(camera, points, 200)
    raster.draw(faces, values)
    left, right, below, above = raster.extent
    x = left + (right - left) * (np.arange(raster.shape[1]) + 0.5) / raster.shape[1]
    y = below + (above - below) * (np.arange(raster.shape[0]) + 0.5) / raster.shape[0]
    pixel = (right - left) / raster.shape[1]
    x, y = np.meshgrid(x, y)

    def inside(low, high, margin):
        return (np.minimum(x, y) > low + margin) & (np.maximum(x, y) < high - margin)

    assert np.allclose(raster.value[inside(1, 3, pixel)], 3)
    only_below = inside(0, 4, pixel) & ~inside(1, 3, -2 * pixel)
    assert np.abs(raster.value[only_below] - x[only_below] / 4).max() < pixel
    assert np.isnan(raster.value[~inside(0, 4, -2 * pixel)]).all()
    # A line across is seen beside the small face alone.
    raster.points = np.concatenate([raster.points, [[0.1, 2, 0.1], [3.9, 2, 0.1]]])
    raster.line(np.array([[16, 17, 16]]), 1.0)
    along = raster.lines.max(axis=0) > 0
    x = x[0]
    assert along[(x > 0.2) & (x < 0.9)].all()
    assert along[(x > 3.1) & (x < 3.8)].all()
    assert not along[(x > 1.1) & (x < 2.9)].any()


def test_edges_of_bodies_are_sharp_and_those_of_cells_are_not():
    corners = np.array([(x, y, z) for z in (0, 1) for y in (0, 1) for x in (0, 1, 2)], dtype=float)
    # Two cubes side by side: the faces around them, without the one between.
    row = {tuple(corner): k for k, corner in enumerate(corners)}
    faces = []
    for x in (0, 1):
        for face in HEXAHEDRON:
            cube = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)]
            places = [(cube[k][0] + x, *cube[k][1:]) for k in face]
            if {place[0] for place in places} != {1}:
                faces.append(np.array([row[place] for place in places]))
    sharp, smooth = edges_of(faces, corners)
    assert len(faces) == 10
    # Of the box, whose long edges are two each, and around its middle.
    assert len(sharp) == 16
    assert len(smooth) == 4
    assert (corners[smooth[:, :2]][..., 0] == 1).all()


def test_steps_are_counted_in_whole_numbers(scene, tmp_path):
    model = Model.from_scene(scene("stack3d"))
    model.steps({"scale": 0.5}, {"scale": 1.0})
    result = model.run(folder=tmp_path, progress=False)
    ticks = numbers(result)
    assert {"1", "2"} <= ticks
    assert not [tick for tick in ticks if "." in tick]
    for step, time in zip(result.report["steps"], (0.5, 1.5)):
        step["time"] = time
    assert "0.6" in numbers(result)


def numbers(result):
    """The bare numbers that the figure of load steps says."""
    with plt.rc_context(pages.FONTS):
        section = pages.steps(result.report, units_of(result))
    words = re.findall(r">([^<>]+)<", section[: section.index("</svg>")])
    return {word.strip() for word in words if re.fullmatch(r"[\d.]+", word.strip())}


def test_a_hole_in_a_side_stays_open_in_its_map():
    x, y = (grid.ravel() * 1.0 for grid in np.meshgrid(range(7), range(7)))
    chart = Chart(np.arange(49), x, y, ("x", "y"))

    def face(i, j):
        """The nodes around a cell, those in the middle of its edges among them."""
        around = [(0, 0), (1, 0), (2, 0), (2, 1), (2, 2), (1, 2), (0, 2), (0, 1)]
        return [7 * (j + dj) + i + di for di, dj in around]

    def area(mesh):
        a, b, c = np.stack([mesh.x, mesh.y], axis=1)[mesh.triangles].swapaxes(0, 1)
        return np.abs(np.linalg.det(np.stack([b - a, c - a], axis=1))).sum() / 2

    cells = [(i, j) for i in (0, 2, 4) for j in (0, 2, 4)]
    rim = [face(i, j) for i, j in cells if (i, j) != (2, 2)]
    assert area(triangulation(chart, rim)) == pytest.approx(32)
    # Of faces that reach over a hole, what lies between nodes with constraints is shown.
    over = [node if node != 25 else None for node in face(2, 2)]
    assert area(triangulation(chart, [*rim, over])) == pytest.approx(34)
    # The node in the middle of a face is joined to those around it; where an edge is missing half of the face is left.
    middle = [*face(2, 2), 24]
    assert len(triangulation(chart, [*rim, middle]).triangles) == 8 * 6 + 8
    tip = [None if node in (32, 31, 30) else node for node in middle]
    assert area(triangulation(chart, [*rim, tip])) == pytest.approx(34)
    # Of four nodes on edges the two opposite ones are joined that differ less.
    left, below = np.where(np.arange(49) == 21, 1.0, 0.0), np.where(np.arange(49) == 15, 1.0, 0.0)
    for values, joined, apart in ((left, {15, 29}, {21, 23}), (below, {21, 23}, {15, 29})):
        mesh = triangulation(chart, [face(0, 2), *rim], values)
        assert any(joined <= set(triangle) for triangle in mesh.triangles.tolist())
        assert not any(apart <= set(triangle) for triangle in mesh.triangles.tolist())
    # Where no faces are known, neighbours are joined.
    assert area(triangulation(chart, [])) == pytest.approx(36)
