"""Maps of the pressures of contacts in space: the side of each flat, with its own coordinates."""

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.lines import Line2D
from matplotlib.patches import Circle
from matplotlib.ticker import MultipleLocator
from matplotlib.tri import Triangulation

from contact_dd.drawing.chart import chart_of
from contact_dd.drawing.surface import corners_of, face_centres
from contact_dd.drawing.units import in_units

# The colours of pressures, from none to the largest.
COLOURS = "inferno_r"
LEVELS = 101
# Least and largest width of a map, and what stands beside it, and above and below it (inches).
NARROWEST, WIDEST, BESIDE, ABOVE = 1.2, 4.2, 1.4, 0.75
# Width of a map over that of the part under pressure.
AROUND = 1.3
# Share of the nodes of a map that faces have if the map consists of these.
MOST_NODES = 0.75
# Of the nodes of the mesh.
DOT = {"ls": "", "marker": ".", "color": "0.6"}


class PressureMap:
    """The pressures of a contact on its side, flat: as much of it as presses, and a bit around."""

    def __init__(self, name, solid):
        table = solid.pressed[name]
        self.name, self.units, self.chart = name, solid.units, chart_of(table)
        (self.pressure, self.unit) = in_units(table["pressure"][self.chart.rows], self.units.stress)
        tags = table["node_a"][self.chart.rows].tolist()
        row = {tag: row for row, tag in enumerate(tags)}
        centres = face_centres(solid.result, table["node_a"])
        faces = []
        for face, _ in solid.facing(table):
            nodes = solid.result.nodes[face].tolist()
            middle = centres.get(tuple(sorted(corners_of(nodes))))
            faces.append([row.get(tag) for tag in [*nodes, middle][: None if middle in row else -1]])
        self.mesh = triangulation(self.chart, faces, self.pressure)
        closed = self.pressure > 0
        places = self.chart.x, self.chart.y
        half = AROUND / 2 * max(np.ptp(of[closed]) for of in places)
        middle = [(of[closed].min() + of[closed].max()) / 2 for of in places]
        self.limits = [(max(at - half, of.min()), min(at + half, of.max())) for at, of in zip(middle, places)]

    def width(self, height):
        """Width of the map with its axis and colours, for this height including title and labels (inches)."""
        wide, tall = (most - least for least, most in self.limits)
        height = height - ABOVE
        return float(np.clip(height * wide / max(tall, 1e-9 * wide), NARROWEST, WIDEST)) + BESIDE

    def draw(self, axes, circle=None):
        chart, length = self.chart, self.units.length
        # Between nodes pressures are interpolated: colours between these would be others than the scale's.
        levels = np.linspace(0, self.pressure.max(), LEVELS)
        axes.tricontourf(self.mesh, self.pressure, levels, cmap=COLOURS, extend="min", antialiased=False)
        colours = plt.cm.ScalarMappable(plt.Normalize(0, levels[-1]), COLOURS)
        axes.plot(chart.x, chart.y, **DOT, ms=1.2)
        if circle:
            label = f"a = {circle:.4g} {length}"
            dashed = Circle((0, 0), circle, fill=False, ec="#1746a2", lw=1.4, ls="--", label=label)
            axes.add_patch(dashed)
            axes.legend(handles=[dashed], loc="upper right", fontsize=8)
        axes.set_xlim(self.limits[0])
        axes.set_ylim(self.limits[1])
        axes.tick_params(labelsize=7)
        if chart.radius:
            # The arc is drawn to scale, and labelled by its angle.
            axes.xaxis.set_major_locator(MultipleLocator(chart.radius * np.radians(self.step_of_angle())))
            axes.xaxis.set_major_formatter(lambda arc, _: degrees(arc / chart.radius))
            axes.set_xlabel(chart.labels[0].with_unit("°"), fontsize=8)
        else:
            axes.set_xlabel(chart.labels[0].with_unit(length), fontsize=8)
        axes.set_ylabel(chart.labels[1].with_unit(length), fontsize=8)
        bar = axes.figure.colorbar(colours, ax=axes, shrink=0.85, pad=0.02)
        bar.set_label(f"pressure [{self.unit}]", fontsize=8)
        bar.ax.tick_params(labelsize=7)
        axes.set_title(f"{self.name}, at most {self.pressure.max():.4g} {self.unit}", fontsize=9, parse_math=False)

    def step_of_angle(self):
        """Between the numbers at the axis (degrees)."""
        shown = np.degrees(np.ptp(self.limits[0]) / self.chart.radius)
        return next((step for step in (1, 2, 5, 10, 15, 30, 45) if shown <= 5 * step), 90)


def triangulation(chart, faces, values=None):
    """The triangles between the nodes of a chart: those of these faces, so that holes stay open, each with the nodes
    around it, `None` for one that isn't there; or between all neighbours where faces are unknown. Nodes are joined
    along the values that they are to be coloured by."""
    triangles = [triangle for face in faces for triangle in triangles_of(face, values)]
    whole = Triangulation(chart.x, chart.y)
    if not triangles or len(np.unique(triangles)) < MOST_NODES * len(np.unique(whole.triangles)):
        return whole
    # A face across the cut of a side that is unrolled has ends on both sides of the chart.
    reaches = np.ptp(chart.x[np.array(triangles)], axis=1) > np.ptp(chart.x) / 2
    return Triangulation(chart.x, chart.y, triangles, mask=reaches if chart.radius else None)


def triangles_of(face, values):
    """The triangles of a face between nodes that are there: around the one in its middle, which comes last; without it
    between corners, and nodes on edges unless none of these is."""
    if len(face) == 9:
        around = face[:8]
        found = [(face[8], *ends) for ends in zip(around, around[1:] + around[:1])]
        return [triangle for triangle in found if None not in triangle]
    corners = corners_of(face)
    middles = face[1::2] if len(face) > len(corners) else []
    if all(node is None for node in middles):
        found = fan(corners)
    else:
        found = [*zip(middles[-1:] + middles[:-1], corners, middles), *fan(along_values(middles, values))]
    return [triangle for triangle in found if None not in triangle]


def along_values(middles, values):
    """The nodes of a polygon from the one that a fan begins with: of four one of those opposite nodes that differ less,
    without which a value would reach across its face as a spike."""
    if values is None or len(middles) != 4 or None in middles:
        return middles
    a, b, c, d = values[middles]
    return middles[1:] + middles[:1] if abs(a - c) > abs(b - d) else middles


def fan(polygon):
    """The triangles of a polygon."""
    return [(polygon[0], b, c) for b, c in zip(polygon[1:], polygon[2:])]


def degrees(angle):
    return f"{np.degrees(angle):.0f}".replace("-", "−")


def legend(figure):
    """What the dots of maps are, below them."""
    dot = Line2D([], [], **DOT, ms=4, label="node of the mesh")
    figure.legend(handles=[dot], loc="outside lower center", frameon=False, fontsize=8)
