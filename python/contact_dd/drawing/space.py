"""Pictures of a result in space: its surface by displacement and von Mises stress, and the pressures of contacts.

By matplotlib, which draws wherever a page is made: a renderer of OpenGL needs libraries that clusters often lack."""

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.tri import Triangulation
from mpl_toolkits.mplot3d.art3d import Poly3DCollection

from contact_dd.drawing.canvas import deformation_of, round_below
from contact_dd.drawing.carried import carried
from contact_dd.drawing.chart import chart_of
from contact_dd.drawing.plane import von_mises
from contact_dd.drawing.units import in_units, units_of
from contact_dd.errors import InputError

# Faces of VTK's cells around their corners, with the nodes on edges where there are some.
TETRAHEDRON = [(0, 2, 1), (0, 1, 3), (1, 2, 3), (0, 3, 2)]
HEXAHEDRON = [(0, 3, 2, 1), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7), (4, 5, 6, 7)]
EDGES = {
    4: {(0, 1): 4, (1, 2): 5, (0, 2): 6, (0, 3): 7, (1, 3): 8, (2, 3): 9},
    8: {
        (0, 1): 8, (1, 2): 9, (2, 3): 10, (0, 3): 11, (4, 5): 12, (5, 6): 13, (6, 7): 14, (4, 7): 15,
        (0, 4): 16, (1, 5): 17, (2, 6): 18, (3, 7): 19,
    },
}
CELLS = {10: (4, False), 12: (8, False), 24: (4, True), 25: (8, True), 29: (8, True)}

# The largest displacement over the size, as `auto` draws it.
VISIBLE = 0.03
# Where the eye is: above, to the left.
VIEW = {"elev": 20, "azim": -125}
# Cosine of the angle to the eye beyond which a face is seen in no perspective.
AWAY = 0.3
# Cosine of the angle to the normal of a contact below which a face isn't one of its side a.
SAME_WAY = 0.7
# More faces are drawn without their edges.
MANY_FACES = 20_000
# Width of a part that presses, relative to what is shown of it.
AROUND = 1.3


def outline(kind, face):
    """The nodes around a face, those on its edges among them."""
    corners, is_quadratic = CELLS[kind]
    nodes = []
    for a, b in zip(face, face[1:] + face[:1]):
        nodes.append(a)
        if is_quadratic:
            nodes.append(EDGES[corners][min(a, b), max(a, b)])
    return nodes


def surface(cells, tags):
    """The nodes around every face of one cell only."""
    faces, keys = [], []
    for kind, _, nodes in cells:
        for face in TETRAHEDRON if CELLS[kind][0] == 4 else HEXAHEDRON:
            faces.extend(nodes[:, outline(kind, face)])
            corners = np.sort(tags[nodes[:, face]], axis=1)
            keys.append(corners[:, :3])
    _, first, count = np.unique(np.concatenate(keys), axis=0, return_index=True, return_counts=True)
    return [faces[k] for k in first[count == 1]]


class Solid:
    """The surface of a result in space, deformed, enlarged by `scale`, without one until it shows."""

    def __init__(self, result, scale=None):
        self.result, self.units = result, units_of(result)
        self.faces = surface(result.cells, result.nodes)
        size = np.ptp(result.points, axis=0).max()
        largest = np.linalg.norm(result.deformation, axis=1).max()
        self.scale = scale or (round_below(VISIBLE * size / largest) if largest > 0 else 1.0)
        self.points = result.points + self.scale * result.deformation
        self.pressed = {
            name: table for name, table in carried(result.contacts).items() if table["pressure"].max(initial=0) > 0
        }

    def has_stress(self):
        return len(self.result.stress) > 0

    def of_faces(self, values):
        """The mean of values at nodes for every face."""
        return np.array([values[face].mean() for face in self.faces])

    def axes(self, figure, place):
        axes = figure.add_subplot(*place, projection="3d", computed_zorder=False)
        # Of what is there.
        points = self.points[np.unique(np.concatenate(self.faces))]
        low, high = points.min(axis=0), points.max(axis=0)
        axes.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]), zlim=(low[2], high[2]))
        # Flat bodies are as wide as the axes across their diagonal.
        size = high - low
        axes.set_box_aspect(size, zoom=min(1.1, 0.9 * np.linalg.norm(size) / np.linalg.norm(size[:2])))
        axes.view_init(**VIEW)
        axes.set_axis_off()
        return axes

    def coloured(self, axes, values, label, cmap="viridis", most=None):
        """Draws the surface by a value for each face, but for what looks away."""
        colours = plt.cm.ScalarMappable(plt.Normalize(0, most or values.max() or 1), cmap)
        seen = [k for k, face in enumerate(self.faces) if looks_here(self.points[face])]
        axes.add_collection3d(Poly3DCollection(
            [self.points[self.faces[k]] for k in seen], facecolors=colours.to_rgba(values[seen]), edgecolors="k",
            linewidths=0.2 if len(seen) < MANY_FACES else 0,
        ))
        axes.figure.colorbar(colours, ax=axes, shrink=0.7, label=label)

    def von_mises(self, axes):
        (values, unit) = in_units(von_mises(self.result.stress), self.units.stress)
        values = self.of_faces(values)
        self.coloured(axes, values, f"von Mises stress [{unit}]", most=np.quantile(values, 0.99))
        axes.set_title(f"{deformation_of(self.result)} × {self.scale:g}", fontsize=10)

    def displacement(self, axes):
        size = np.linalg.norm(self.result.displacement, axis=1)
        (values, unit) = in_units(size, self.units.length)
        self.coloured(axes, self.of_faces(values), f"displacement [{unit}]", "cividis")
        axes.set_title(f"at most {values.max():.4g} {unit}", fontsize=10)

    def pressure(self, axes):
        """The sides a of contacts by their pressures, through the bodies."""
        faces, values = [], []
        for table in self.pressed.values():
            found, of_found = self.side(table)
            faces += found
            values.append(of_found)
        (values, unit) = in_units(np.concatenate(values), self.units.stress)
        most = max(table["pressure"].max() for table in self.pressed.values())
        ((most,), _) = in_units(np.array([most]), self.units.stress)
        colours = plt.cm.ScalarMappable(plt.Normalize(0, most), "inferno_r")
        bodies = [self.points[face] for face in self.faces if looks_here(self.points[face])]
        axes.add_collection3d(Poly3DCollection(bodies, facecolors="0.5", edgecolors="0.4", alpha=0.06, linewidths=0.15))
        # What doesn't press is seen through: it may lie before what does.
        presses = values > 0
        polygons = [self.points[face] for face in faces]
        idle = [polygons[k] for k in np.flatnonzero(~presses)]
        axes.add_collection3d(Poly3DCollection(idle, facecolors="0.5", edgecolors="0.4", alpha=0.06, linewidths=0.15))
        loaded = [polygons[k] for k in np.flatnonzero(presses)]
        axes.add_collection3d(Poly3DCollection(loaded, facecolors=colours.to_rgba(values[presses]), edgecolors="none"))
        axes.figure.colorbar(colours, ax=axes, shrink=0.7, label=f"contact pressure [{unit}]")
        axes.set_title(f"at most {most:.4g} {unit}", fontsize=10)

    def side(self, table):
        """The faces of side a of a contact, and the mean pressure of each: those that look its way, all corners of
        which have conditions or are at the tip of a crack."""
        rows = {tag: row for row, tag in enumerate(table["node_a"].tolist())}
        tags = self.result.nodes
        is_known = np.isin(tags, table["node_a"])
        is_on = is_known | self.is_tip(table["normal"].mean(axis=0))
        faces, means = [], []
        for face in self.faces:
            corners = face if len(face) < 6 else face[::2]
            if not is_on[corners].all() or not is_known[corners].any():
                continue
            known = [rows[tag] for tag in tags[face[is_known[face]]].tolist()]
            if table["normal"][known].mean(axis=0) @ unit_normal(self.result.points[face]) > SAME_WAY:
                faces.append(face)
                means.append(table["pressure"][known].mean())
        return faces, np.array(means)

    def is_tip(self, normal):
        """At which nodes faces look along a normal and against it."""
        least, most = np.full((2, len(self.result.nodes)), [[1.0], [-1.0]])
        for face in self.faces:
            along = unit_normal(self.result.points[face]) @ normal
            least[face] = np.minimum(least[face], along)
            most[face] = np.maximum(most[face], along)
        return (least < -SAME_WAY) & (most > SAME_WAY)

    def pictures(self):
        """What there is to draw, by name."""
        drawn = {"displacement": self.displacement}
        if self.has_stress():
            drawn["von_mises"] = self.von_mises
        if self.pressed:
            drawn["pressure"] = self.pressure
        return drawn


def looks_here(polygon):
    """Whether a face looks to where the eye is, or not much away from it."""
    elevation, azimuth = np.radians([VIEW["elev"], VIEW["azim"]])
    eye = [np.cos(elevation) * np.cos(azimuth), np.cos(elevation) * np.sin(azimuth), np.sin(elevation)]
    return unit_normal(polygon) @ eye > -AWAY


def unit_normal(polygon):
    normal = area(polygon)
    return normal / np.linalg.norm(normal)


def area(polygon):
    """The area of a polygon times its normal."""
    arms = polygon[1:] - polygon[0]
    return np.cross(arms[:-1], arms[1:]).sum(axis=0) / 2


def panels(result):
    """Displacement, von Mises stress and contact pressure on the surface, side by side."""
    solid = Solid(result)
    drawn = solid.pictures()
    figure = plt.figure(figsize=(4.2 * len(drawn), 3.6), layout="constrained")
    figure.get_layout_engine().set(w_pad=0.12)
    for place, draw in enumerate(drawn.values(), start=1):
        draw(solid.axes(figure, (1, len(drawn), place)))
    return figure


def single(name):
    def draw(result, scale):
        solid = Solid(result, scale)
        if name not in solid.pictures():
            raise InputError(f"{result.path}: there is no {name.replace('_', ' ')} to draw")
        figure = plt.figure(figsize=(6.4, 4.8), layout="constrained")
        solid.pictures()[name](solid.axes(figure, (1, 1, 1)))
        return figure

    return draw


def overview(result, scale):
    """The surface by von Mises stress, and the pressures of the contact with the largest one."""
    if len(result.stress) == 0:
        raise InputError(f"{result.path}: there are no stresses; expected a run without --no-stress")
    solid = Solid(result, scale)
    pressed = solid.pressed
    figure = plt.figure(figsize=(9.6 if pressed else 6.4, 4.8), layout="constrained")
    figure.get_layout_engine().set(w_pad=0.12)
    solid.von_mises(solid.axes(figure, (1, 2 if pressed else 1, 1)))
    if pressed:
        name = max(pressed, key=lambda name: pressed[name]["pressure"].max())
        pressure_map(figure, name, pressed[name], solid.units)
    return figure


def pressure_map(figure, name, table, units):
    """The pressures of a contact on its side, flat."""
    axes = figure.add_subplot(1, 2, 2, aspect="equal")
    chart = chart_of(table)
    x, y = chart.x, chart.y
    (pressure, unit) = in_units(table["pressure"][chart.rows], units.stress)
    colours = axes.tripcolor(Triangulation(x, y), pressure, shading="gouraud", cmap="inferno_r", vmin=0)
    axes.plot(x, y, ".", color="0.6", ms=1.5)
    closed = pressure > 0
    for of, limit in ((x, axes.set_xlim), (y, axes.set_ylim)):
        middle = (of[closed].min() + of[closed].max()) / 2
        half = max(np.ptp(x[closed]), np.ptp(y[closed])) * AROUND / 2
        limit(max(middle - half, of.min()), min(middle + half, of.max()))
    axes.tick_params(labelsize=8)
    axes.set_xlabel(f"{chart.labels[0]} [{units.length}]", fontsize=8)
    axes.set_ylabel(f"{chart.labels[1]} [{units.length}]", fontsize=8)
    figure.colorbar(colours, ax=axes, shrink=0.7, label=f"contact pressure [{unit}]")
    axes.set_title(f"{name}, at most {pressure.max():.4g} {unit}", fontsize=10, parse_math=False)


PICTURES = {
    "overview": overview, "displacement": single("displacement"), "von_mises": single("von_mises"),
    "pressure": single("pressure"),
}
