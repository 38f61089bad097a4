"""Pictures of a result in space: its surface by displacement and von Mises stress, and the pressures of contacts."""

import matplotlib.pyplot as plt
import numpy as np

from contact_dd.drawing import symbols
from contact_dd.drawing.canvas import deformation_of, round_below
from contact_dd.drawing.carried import carried, pressing
from contact_dd.drawing.conditions import conditions_of
from contact_dd.drawing.glass import draw_glass, is_seen_through
from contact_dd.drawing.plane import von_mises
from contact_dd.drawing.pressure_map import COLOURS, PressureMap, legend
from contact_dd.drawing.raster import Camera, Raster, edges_of
from contact_dd.drawing.surface import corners_of, mean_normals, on_surface, surface, unit_normal
from contact_dd.drawing.units import in_units, units_of
from contact_dd.errors import InputError

# The largest displacement over the size, as `auto` draws it.
VISIBLE = 0.03
# Where the eye is: above, to the left.
VIEW = {"elev": 28, "azim": -125}
# Cosine of the angle to the normal of a contact below which a face isn't one of its side a.
SAME_WAY = 0.7
# More faces are drawn without the edges of their cells.
MANY_FACES = 4000
# How far behind the surface, over the size, a node counts as seen.
SEEN = 0.01
# Of a picture (pixels).
WIDTH = 640
# Strengths of lines: edges of bodies and outlines, of cells, of bodies behind pressures.
OF_BODIES, OF_CELLS, BEHIND = 0.85, 0.16, 0.6
# Height of a figure, of the panels of bodies and maps, and of the translucent bodies below them (inches).
TALL, HEIGHT, OF_GLASS = 5.0, 4.7, 3.2
# Most that bodies take (inches).
WIDEST_BODIES = 6.0
# Most contacts whose pressures are shown beside each other.
MOST_MAPS = 4

# Of the directions of x, y and z.
ARROW = {"arrowstyle": "-|>", "lw": 1, "fc": "k", "shrinkA": 0, "shrinkB": 0}


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
            name: table for name, table in carried(pressing(result)).items() if table["pressure"].max(initial=0) > 0
        }
        # Colours are interpolated between the nodes of the surface, and lines are those of the undeformed bodies.
        self.shown = self.points[np.unique(np.concatenate(self.faces))]
        self.edges, self.inner = edges_of(self.faces, result.points)
        self.conditions = conditions_of(result, on_surface(result, self.faces))
        self.normals = self.outward()

    def outward(self):
        """The outward normals at nodes: where all directions are held those of the faces that are."""
        normals = mean_normals(self.result, self.faces)
        held = [support.node for support in self.conditions.supports if len(support.axes) == 3]
        is_held = np.isin(np.searchsorted(self.result.nodes, self.result.nodes), held)
        of_held = mean_normals(self.result, [face for face in self.faces if is_held[face].all()])
        return np.where(of_held.any(axis=1)[:, None], of_held, normals)

    def has_stress(self):
        return len(self.result.stress) > 0

    def raster(self):
        camera = Camera(VIEW["elev"], VIEW["azim"])
        raster = Raster(camera, self.shown, WIDTH)
        raster.points = self.points @ raster.frame.T
        return raster

    def show(self, axes, raster, colours, label):
        """Puts a picture on its axes, with a bar of a round length, the directions of x, y and z, and its colours."""
        axes.imshow(raster.image(colours), extent=raster.extent, origin="lower", interpolation="antialiased")
        axes.set_axis_off()
        bar_and_triad(axes, raster, self.units)
        bar = axes.figure.colorbar(colours, ax=axes, shrink=0.75, pad=0.02, extend=colours.extend)
        bar.ax.tick_params(labelsize=8)
        bar.set_label(label, fontsize=9)

    def coloured(self, axes, values, label, cmap="viridis", most=None):
        """Draws the surface by values at nodes."""
        highest = values[np.unique(np.concatenate(self.faces))].max()
        colours = plt.cm.ScalarMappable(plt.Normalize(0, most or highest or 1), cmap)
        colours.extend = "max" if most and highest > 1.001 * most else "neither"
        raster = self.raster()
        raster.draw(self.faces, values)
        if len(self.faces) < MANY_FACES:
            raster.line(self.inner, OF_CELLS)
        raster.line(self.edges, OF_BODIES, thickness=2)
        raster.outline(OF_BODIES)
        self.show(axes, raster, colours, label)
        self.supports_and_loads(axes, raster)
        return highest

    def supports_and_loads(self, axes, raster):
        """Symbols of supports and loads on the visible surface, with a legend."""
        pixel = raster.pixels(raster.points)
        is_before = raster.points[:, 2] + SEEN * max(raster.size) >= raster.depth.reshape(-1)[pixel]
        seen = self.conditions.seen(is_before)
        paper = symbols.Paper(raster.points[:, :2], self.normals, raster.frame[:2], max(raster.size[:2]))
        drawn = symbols.draw(axes, paper, seen)
        # Reference points may be far from the bodies, and arrows of loads reach beyond them.
        held = [support.node for support in drawn.supports]
        shown = np.concatenate([paper.places[[*seen.nodes, *held]], symbols.ends(paper, seen, reach(raster.size))])
        around = 0.4 * reach(raster.size)
        for limits, change, k in ((axes.get_xlim(), axes.set_xlim, 0), (axes.get_ylim(), axes.set_ylim, 1)):
            least, most = shown[:, k].min(initial=np.inf), shown[:, k].max(initial=-np.inf)
            change(min(limits[0], least - around), max(limits[1], most + around))
        if key := symbols.entries(drawn, 3):
            axes.legend(handles=key, loc="upper center", bbox_to_anchor=(0.5, 0.0), ncol=2, frameon=False, fontsize=8,
                        columnspacing=1.2)

    def title(self, axes, words):
        axes.set_title(f"{words}\n{deformation_of(self.result, self.scale)}", fontsize=9)

    def von_mises(self, axes):
        (values, unit) = in_units(von_mises(self.result.stress), self.units.stress)
        on_surface = np.unique(np.concatenate(self.faces))
        most = np.quantile(values[on_surface], 0.99)
        highest = self.coloured(axes, values, f"von Mises stress [{unit}]", most=most or None)
        self.title(axes, f"Von Mises stress, on the surface at most {highest:.4g} {unit}")

    def displacement(self, axes):
        size = np.linalg.norm(self.result.displacement, axis=1)
        (values, unit) = in_units(size, self.units.length)
        self.coloured(axes, values, f"displacement [{unit}]", "cividis")
        self.title(axes, f"Displacement, at most {values.max():.4g} {unit}")

    def pressure(self, axes):
        """The sides a of contacts by their pressures, without the bodies, of which edges are left."""
        faces = []
        values = np.zeros(len(self.points))
        for table in self.pressed.values():
            faces += self.side(table)[0]
            values = np.maximum(values, self.at_nodes(table))
        most = max(table["pressure"].max() for table in self.pressed.values())
        (values, unit) = in_units(values, self.units.stress)
        ((most,), _) = in_units(np.array([most]), self.units.stress)
        colours = plt.cm.ScalarMappable(plt.Normalize(0, most), COLOURS)
        colours.extend = "neither"
        raster = self.raster()
        # Open parts are left out: they may lie before closed ones.
        loaded = [face for face in faces if values[face].max() > 0]
        raster.draw(loaded, values)
        raster.line(edges_of(loaded, self.points)[0], OF_BODIES)
        shown, raster.depth = raster.depth, np.full_like(raster.depth, -np.inf)
        raster.line(self.edges, BEHIND)
        raster.depth = shown
        self.show(axes, raster, colours, f"contact pressure [{unit}]")
        axes.set_title(f"Contact pressure, at most {most:.4g} {unit}\nbetween the edges of the bodies", fontsize=9)

    def at_nodes(self, table):
        """The pressures of a contact at nodes, 0 where it has none."""
        tags, points = np.unique(self.result.nodes, return_inverse=True)
        pressure = np.zeros(len(tags))
        np.maximum.at(pressure, np.searchsorted(tags, table["node_a"]), table["pressure"])
        return pressure[points]

    def side(self, table):
        """The faces of side a of a contact, and the mean pressure of each: those all corners of which have constraints
        or are at the tip of a crack."""
        is_on = np.isin(self.result.nodes, table["node_a"]) | self.is_tip(table["normal"].mean(axis=0))
        found = [(face, table["pressure"][rows].mean()) for face, rows in self.facing(table)
                 if is_on[corners_of(face)].all()]
        return [face for face, _ in found], np.array([mean for _, mean in found])

    def facing(self, table):
        """The faces with corners on side a of a contact that face side b, each with the rows of its nodes there."""
        row_of = {tag: row for row, tag in enumerate(table["node_a"].tolist())}
        tags = self.result.nodes
        is_known = np.isin(tags, table["node_a"])
        for face in self.faces:
            if is_known[corners_of(face)].any():
                rows = [row_of[tag] for tag in tags[face[is_known[face]]].tolist()]
                if table["normal"][rows].mean(axis=0) @ unit_normal(self.result.points[face]) > SAME_WAY:
                    yield face, rows

    def is_tip(self, normal):
        """At which nodes faces look along a normal and against it."""
        least, most = np.full((2, len(self.result.nodes)), [[1.0], [-1.0]])
        for face in self.faces:
            along = unit_normal(self.result.points[face]) @ normal
            least[face] = np.minimum(least[face], along)
            most[face] = np.maximum(most[face], along)
        return (least < -SAME_WAY) & (most > SAME_WAY)

    def pictures(self):
        """Drawings, by name."""
        drawn = {"displacement": self.displacement}
        if self.has_stress():
            drawn["von_mises"] = self.von_mises
        if self.pressed:
            drawn["pressure"] = self.pressure
        return drawn


def reach(size):
    """The length of the longest arrow of a load where a picture of this size fills its place."""
    wide, tall = size[:2]
    return symbols.LONGEST / 72 * max(wide / WIDEST_BODIES, tall / (HEIGHT - 1.0))


def bar_and_triad(axes, raster, units):
    """A bar of a round length, and where x, y and z point to, below a picture."""
    left, right, below, above = raster.extent
    width, height = right - left, above - below
    length = round_below(0.25 * width)
    (shown,), unit = in_units(np.array([length]), units.length)
    y = below - 0.06 * height
    axes.plot([left, left + length], [y, y], "k", lw=2.5, solid_capstyle="butt")
    axes.annotate(f"{shown:g} {unit}", (left + length / 2, y), xytext=(0, -3), textcoords="offset points", ha="center",
                  va="top", fontsize=8)
    corner = np.array([right - 0.14 * width, below - 0.1 * height])
    for direction, name in zip(raster.frame[:2].T, "xyz"):
        end = corner + 0.1 * min(width, height) * direction
        if np.linalg.norm(direction) > 0.1:
            axes.annotate("", end, corner, arrowprops=ARROW)
        axes.annotate(name, end + 0.035 * min(width, height) * direction, fontsize=8, ha="center", va="center")
    axes.set_xlim(left - 0.01 * width, right + 0.01 * width)
    axes.set_ylim(below - 0.2 * height, above + 0.06 * height)


def panels(result):
    """Displacement, von Mises stress and contact pressure on the surface, side by side."""
    solid = Solid(result)
    drawn = solid.pictures()
    figure = plt.figure(figsize=(min(width_of(solid, 3.0), 4.0) * len(drawn), 3.8), layout="constrained")
    for place, draw in enumerate(drawn.values(), start=1):
        draw(figure.add_subplot(1, len(drawn), place))
    return figure


def width_of(solid, height):
    """How wide a picture of this height is, with its colours (inches)."""
    wide, tall = np.ptp(solid.shown @ Camera(VIEW["elev"], VIEW["azim"]).axes()[:2].T, axis=0)
    return float(np.clip(height * wide / (1.2 * tall), 2.6, WIDEST_BODIES)) + 1.3


def single(name):
    def draw(result, scale):
        solid = Solid(result, scale)
        if name not in solid.pictures():
            raise InputError(f"{result.path}: there is no {name.replace('_', ' ')} to draw")
        figure = plt.figure(figsize=(width_of(solid, 4.4), 5.2), layout="constrained")
        solid.pictures()[name](figure.add_subplot())
        return laid_out(figure)

    return draw


def laid_out(figure):
    """The figure, laid out once: legends below axes of equal scales have their places at the second time alone."""
    figure.draw_without_rendering()
    return figure


def overview(result, scale, circle=None):
    """The surface by von Mises stress, and the pressures of contacts, of many those with the largest. `circle` is the
    radius of one around the origin of their maps."""
    if len(result.stress) == 0:
        raise InputError(f"{result.path}: there are no stresses; expected a run without --no-stress")
    solid = Solid(result, scale)
    pressed = sorted(solid.pressed, key=lambda name: -solid.pressed[name]["pressure"].max())[:MOST_MAPS]
    maps = [PressureMap(name, solid) for name in pressed]
    glass = OF_GLASS if is_seen_through(solid, pressed) else 0.0
    columns = 1 if len(maps) < 3 else 2
    rows = -(-len(maps) // columns)
    height = (HEIGHT + glass) / max(rows, 1)
    left, right = width_of(solid, 4.0), columns * max((one.width(height) for one in maps), default=0.0)
    figure = plt.figure(figsize=(left + right, TALL + glass), layout="constrained")
    figure.get_layout_engine().set(w_pad=0.08)
    parts = figure.subfigures(1, 2, width_ratios=[left, right]) if maps else [figure]
    below = parts[0].add_gridspec(1 + bool(glass), 1, height_ratios=[TALL, glass] if glass else [TALL])
    solid.von_mises(parts[0].add_subplot(below[0]))
    if glass:
        draw_glass(parts[0].add_subplot(below[1]), solid, pressed)
    for place, one in enumerate(maps, start=1):
        one.draw(parts[1].add_subplot(rows, columns, place, aspect="equal"), circle)
    if maps:
        legend(parts[1])
    step = f", step {result.step} of {result.steps}" if result.steps > 1 else ""
    left_out = len(solid.pressed) - len(pressed)
    more = f" ({len(pressed)} of {len(solid.pressed)} contacts)" if left_out else ""
    if result.title or step or more:
        figure.suptitle(f"{result.title}{step}{more}", fontsize=11, parse_math=False)
    return laid_out(figure)


PICTURES = {
    "overview": overview, "displacement": single("displacement"), "von_mises": single("von_mises"),
    "pressure": single("pressure"),
}
