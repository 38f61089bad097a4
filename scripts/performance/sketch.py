"""A sketch: bodies, supports, loads and contacts, drawn by hand or from the result of a built-in scene."""

import pathlib
import subprocess
import sys
import tempfile

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.patches import PathPatch
from matplotlib.path import Path

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "python"))
from contact_dd import Result, programs
from contact_dd.drawing import symbols
from contact_dd.drawing.carried import carried
from contact_dd.drawing.conditions import conditions_of
from contact_dd.drawing.overview import seen_in, window
from contact_dd.drawing.plane import Plane
from contact_dd.drawing.sides import sides_of

# Of a sketch (inches), and its colours.
SIZE = (4.2, 3.2)
BODY, CONTACT, RIGID = "#dfe5ea", "#d6202c", "#555555"
DOWN, UP, LEFT, RIGHT = (np.array(axis, dtype=float) for axis in ((0, -1), (0, 1), (-1, 0), (1, 0)))


class Sketch:
    """A drawing of one case."""

    def __init__(self):
        self.figure, self.axes = plt.subplots(figsize=SIZE, layout="constrained")
        self.axes.set_aspect("equal")
        self.axes.set_axis_off()
        self.axes.margins(0.14)
        self.named = {}

    def body(self, points):
        self.axes.fill(*np.transpose(points), fc=BODY, ec="k", lw=1.1)

    def contact(self, points, words="contact"):
        (self.named[words],) = self.axes.plot(*np.transpose(points), color=CONTACT, lw=2.6, zorder=4)

    def rigid(self, points, depth):
        """An obstacle that can't deform, on the side of `depth`."""
        line = np.asarray(points, dtype=float)
        shape = np.concatenate([line, line[::-1] + depth])
        (self.named["rigid obstacle"],) = self.axes.fill(*shape.T, fc="none", ec=RIGID, hatch="////", lw=0.0)
        self.axes.plot(*line.T, color=RIGID, lw=1.4)

    def put(self, paths, places, face, edge, width):
        symbols.put(self.axes, paths, places, face, edge, width, 6)

    def held(self, points, outward, kind=symbols.ROLLER, count=5):
        """Supports along a line: fixed, on rollers along the direction outward, or moved."""
        places = along(points, count)
        under = symbols.FIXED if kind == "fixed" else symbols.ROLLED
        edge = symbols.GIVEN if kind == "prescribed displacement" else symbols.HELD
        face = symbols.PAPER if kind == symbols.ROLLER else edge
        path = symbols.turned([symbols.TRIANGLE, *under], outward, symbols.TALL)
        self.put([path] * len(places), places, face, edge, 0.9)
        self.name(kind, "^", face, edge)

    def loaded(self, points, force, words="load", count=6, pushes=True):
        """Arrows along a line, by a force or what gives it at a place; the largest is the longest."""
        places = along(points, count)
        forces = np.array([force(place) if callable(force) else force for place in places], dtype=float)
        size = np.linalg.norm(forces, axis=1)
        some = size > 0.02 * size.max()
        paths = [
            symbols.arrow(one / length, 9 + 15 * length / size.max(), pushes)
            for one, length in zip(forces[some], size[some], strict=True)
        ]
        self.put(paths, places[some], symbols.GIVEN, symbols.GIVEN, 0.3)
        self.name(words, symbols.in_legend(), symbols.GIVEN, symbols.GIVEN, 18)

    def nodes(self, points):
        (self.named["node"],) = self.axes.plot(*np.transpose(points), ".", color="k", ms=3, zorder=5)

    def name(self, words, marker, face, edge, size=7):
        handle = plt.Line2D([], [], ls="", marker=marker, ms=size, mfc=face, mec=edge)
        self.named[words] = handle

    def axis(self, points):
        """An axis of symmetry around which the bodies are."""
        (self.named["axis"],) = self.axes.plot(*np.transpose(points), color="k", lw=0.8, ls="-.")

    def text(self, place, words, **style):
        self.axes.annotate(words, place, **{"ha": "center", "va": "center", "fontsize": 8, **style})

    def save(self, path):
        self.axes.legend(
            self.named.values(), self.named.keys(), loc="upper center", bbox_to_anchor=(0.5, 0.02), ncol=2,
            frameon=False, fontsize=8,
        )
        self.figure.savefig(path, metadata={"Date": None})
        plt.close(self.figure)


def along(points, count):
    """Places along a line of points, none at its ends but for a single one."""
    points = np.asarray(points, dtype=float)
    if len(points) == 1:
        return points
    length = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))])
    at = (np.arange(count) + 0.5) / count * length[-1]
    return np.stack([np.interp(at, length, column) for column in points.T], axis=1)


def arc(middle, radius, first, last):
    angle = np.radians(np.linspace(first, last, 61))
    return np.asarray(middle) + radius * np.stack([np.cos(angle), np.sin(angle)], axis=1)


def of_scene(name):
    """What a built-in scene's result shows, undeformed."""
    with tempfile.TemporaryDirectory() as folder:
        problem = pathlib.Path(folder) / f"{name}.h5"
        for command in (["contact-dd-partition", "--example", name, "-o"], ["contact-dd-mpi", "--quiet"]):
            subprocess.run([programs.find(command[0]), *command[1:], problem], check=True, stdout=subprocess.DEVNULL)
        result = Result(problem.with_suffix(".vtkhdf"))
        plane = Plane(result)
        conditions = conditions_of(result, np.unique(plane.outline[plane.outline >= 0]))
    sketch = Sketch()
    sketch.axes.add_patch(PathPatch(around(plane), fc=BODY, ec="k", lw=1.1))
    sketch.axes.autoscale_view()
    panel = window([plane.points], 0.02)
    # A sketch has half of the size of a picture, and symbols of the same size: they stand twice as far apart.
    paper = symbols.Paper(plane.points, plane.normals(), np.eye(2), 2 * max(panel[1] - panel[0]), plane.lengths)
    symbols.draw(sketch.axes, paper, seen_in(conditions, plane.points, [panel]))
    tables = carried(result.contacts_there)
    for side, of in sides_of(result).items():
        for rows, _ in of.pieces:
            sketch.contact(tables[side]["position"][rows, :2])
    for entry in symbols.entries(conditions, 2):
        sketch.named[entry.get_label()] = entry
    if name in OBSTACLES:
        sketch.rigid(*OBSTACLES[name](panel))
    return sketch


def around(plane):
    """The outlines of bodies as one path, in which holes run the other way round."""
    after = {int(a): (int(m), int(b)) for a, m, b in np.where(plane.outline >= 0, plane.tags[plane.outline], -1)}
    place = dict(zip(plane.tags.tolist(), plane.points.tolist(), strict=True))
    points, codes = [], []
    while after:
        start = node = next(iter(after))
        first = len(points)
        while node in after:
            points.append(place[node])
            middle, node = after.pop(node)
            if middle in place:
                points.append(place[middle])
        points.append(place[start])
        codes += [Path.MOVETO, *[Path.LINETO] * (len(points) - first - 2), Path.CLOSEPOLY]
    return Path(points, codes)


# Obstacles of scenes: their line, and the side on which they are.
OBSTACLES = {
    "hertz": lambda panel: (parabola([0, 2], 16), [0, 0.25]),
    "raous": lambda panel: ([(0, 0), (panel[1][0], 0)], [0, -0.05 * panel[1][0]]),
}


def parabola(ends, factor):
    x = np.linspace(*ends, 41)
    return np.stack([x, x**2 / factor], axis=1)
