"""Transparent bodies, and the hidden sides of contacts inside them in the colours of their pressure maps."""

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.patheffects import withStroke

from contact_dd.drawing.pressure_map import COLOURS
from contact_dd.drawing.raster import edges_of

# Brightness of bodies.
GREY = 0.75
# Opacity of bodies, of open and of closed parts of contacts.
BODIES, OPEN, PRESSING = 0.35, 0.6, 0.95
# Strengths of lines: edges of bodies that are seen and that are hidden, and of sides.
SEEN, HIDDEN, OF_SIDES = 0.7, 0.3, 0.85
# Least size of the closed parts, relative to the bodies, for which the picture is drawn.
LEAST = 1 / 8


def is_seen_through(solid, names):
    """Whether the closed parts of contacts are large enough to be seen inside the bodies."""
    tables = [solid.pressed[name] for name in names]
    pressing = [table["position"][table["pressure"] > 0] for table in tables]
    size = np.ptp(solid.result.points, axis=0).max()
    return bool(pressing) and np.ptp(np.concatenate(pressing), axis=0).max() > LEAST * size


def draw_glass(axes, solid, names):
    """Draws the bodies and the sides of these contacts, each with its name."""
    grey, colours = (plt.cm.ScalarMappable(plt.Normalize(0, 1), name) for name in ("gray", COLOURS))
    bodies = drawn(solid, solid.faces, np.full(len(solid.points), GREY))
    picture = over(1.0, bodies, grey, BODIES)
    bodies.line(solid.edges, SEEN)
    bodies.outline(SEEN)
    bodies.depth[:] = -np.inf
    bodies.line(solid.edges, HIDDEN)
    for name in names:
        table = solid.pressed[name]
        faces, _ = solid.side(table)
        if not faces:
            continue
        values = solid.at_nodes(table) / table["pressure"].max()
        # Closed parts come last: open ones may lie before them.
        for opacity, some in ((OPEN, [face for face in faces if values[face].max() <= 0]),
                              (PRESSING, [face for face in faces if values[face].max() > 0])):
            if some:
                picture = over(picture, drawn(solid, some, values), colours, opacity)
        bodies.line(edges_of(faces, solid.points)[0], OF_SIDES)
        places = bodies.points[values > 0, :2]
        axes.annotate(name, (places[:, 0].mean(), places[:, 1].max()), xytext=(0, 4), textcoords="offset points",
                      ha="center", va="bottom", fontsize=8, parse_math=False,
                      path_effects=[withStroke(linewidth=2.5, foreground="w")])
    axes.imshow(picture * (1 - bodies.strength()), extent=bodies.extent, origin="lower", interpolation="antialiased")
    axes.set_axis_off()
    axes.set_title("Contacts within the bodies, in the colours of their maps", fontsize=9)


def drawn(solid, faces, values):
    raster = solid.raster()
    raster.draw(faces, values)
    return raster


def over(picture, raster, colours, opacity):
    """A picture behind the faces of a raster."""
    cover = raster.cover()
    return picture * (1 - opacity * cover) + opacity * (raster.image(colours) - (1 - cover))
