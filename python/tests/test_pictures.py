"""What pictures show, beside how they look."""

import re

import matplotlib.pyplot as plt
import numpy as np
import pytest

from contact_dd import Model
from contact_dd.drawing import page as pages
from contact_dd.drawing import space
from contact_dd.drawing.chart import chart_of
from contact_dd.drawing.units import units_of

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
    # By the arc length from where it is loaded, the same way around for all, and the place along the axis.
    way = np.remainder(angle - LOADED + np.pi + 1e-9, 2 * np.pi) - np.pi - 1e-9
    sign = np.sign((way * chart.x).sum())
    is_opposite = np.isclose(way, -np.pi)
    assert np.allclose(chart.x, np.where(is_opposite, RADIUS * np.pi, sign * RADIUS * way))
    assert np.allclose(np.abs(np.subtract.outer(chart.y, chart.y)), np.abs(np.subtract.outer(height, height)))
    assert chart.labels[0] == "around the axis"
    assert chart.labels[1] == ("z" if axis == (0, 0, 1) else "along (-0.27, -0.53, 0.80)")


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
        assert sorted(label.strip("−") for label in chart.labels) == ["x", "y"]


def test_what_doesnt_press_hides_nothing_and_axes_have_names(scene, tmp_path):
    result = Model.from_scene(scene("pin")).run(folder=tmp_path, progress=False)
    figure = space.PICTURES["pressure"](result, None)
    *seen_through, opaque = figure.axes[0].collections
    solid = space.Solid(result)
    values = np.concatenate([solid.side(table)[1] for table in solid.pressed.values()])
    assert 0 < (values > 0).sum() < len(values)
    assert len(opaque.get_facecolor()) == (values > 0).sum()
    assert all(one.get_facecolor()[:, 3].max() < 0.1 for one in seen_through)
    overview = space.overview(result, None)
    assert [axes.get_xlabel() for axes in overview.axes if axes.get_xlabel()] == ["around the axis [mm]"]
    assert "z [mm]" in [axes.get_ylabel() for axes in overview.axes]
    plt.close("all")


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
