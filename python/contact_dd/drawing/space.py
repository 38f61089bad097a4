"""The picture of a result in space: its surface by von Mises stress, and the pressures of a contact."""

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.tri import Triangulation
from mpl_toolkits.mplot3d.art3d import Poly3DCollection

from contact_dd.drawing.canvas import round_below
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


def overview(result, scale):
    """The deformed surface, enlarged by `scale`, without one until it shows."""
    if len(result.stress) == 0:
        raise InputError(f"{result.path}: there are no stresses; expected a run without --no-stress")
    units, points, displacement, stress = units_of(result), result.points, result.displacement, result.stress
    faces = surface(result.cells, result.nodes)
    size = np.ptp(points, axis=0).max()
    largest = np.linalg.norm(displacement, axis=1).max()
    scale = scale or (round_below(VISIBLE * size / largest) if largest > 0 else 1.0)
    moved = points + scale * displacement
    (values, unit) = in_units(von_mises(stress), units.stress)

    pressed = {name: table for name, table in result.contacts.items() if table["pressure"].max(initial=0) > 0}
    figure = plt.figure(figsize=(9.6 if pressed else 6.4, 4.8), layout="constrained")
    axes = figure.add_subplot(1, 2 if pressed else 1, 1, projection="3d", computed_zorder=False)
    of_face = np.array([values[face].mean() for face in faces])
    shown = np.quantile(of_face, 0.99)
    colours = plt.cm.ScalarMappable(plt.Normalize(0, shown), "viridis")
    polygons = [moved[face] for face in faces]
    axes.add_collection3d(
        Poly3DCollection(polygons, facecolors=colours.to_rgba(of_face), edgecolors="k", linewidths=0.2)
    )
    low, high = moved.min(axis=0), moved.max(axis=0)
    axes.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]), zlim=(low[2], high[2]))
    axes.set_box_aspect(high - low)
    axes.view_init(**VIEW)
    axes.set_axis_off()
    figure.colorbar(colours, ax=axes, shrink=0.7, label=f"von Mises stress [{unit}]")
    axes.set_title(f"deformation × {scale:g}", fontsize=10)
    if pressed:
        name = max(pressed, key=lambda name: pressed[name]["pressure"].max())
        pressure_map(figure, name, pressed[name], units)
    return figure


def pressure_map(figure, name, table, units):
    """The pressures of a contact, seen along its mean normal."""
    axes = figure.add_subplot(1, 2, 2, aspect="equal")
    normal = table["normal"].mean(axis=0)
    axis = np.eye(3)[np.abs(normal).argmin()]
    first = np.cross(axis, normal)
    first /= np.linalg.norm(first)
    second = np.cross(normal / np.linalg.norm(normal), first)
    x, y = table["position"] @ first, table["position"] @ second
    (pressure, unit) = in_units(table["pressure"], units.stress)
    colours = axes.tripcolor(Triangulation(x, y), pressure, shading="gouraud", cmap="inferno_r", vmin=0)
    axes.plot(x, y, ".", color="0.6", ms=1.5)
    closed = pressure > 0
    for of, limit in ((x, axes.set_xlim), (y, axes.set_ylim)):
        middle = (of[closed].min() + of[closed].max()) / 2
        half = max(np.ptp(x[closed]), np.ptp(y[closed])) * AROUND / 2
        limit(max(middle - half, of.min()), min(middle + half, of.max()))
    axes.tick_params(labelsize=8)
    figure.colorbar(colours, ax=axes, shrink=0.7, label=f"contact pressure [{unit}]")
    axes.set_title(f"{name}, at most {pressure.max():.4g} {unit}", fontsize=10)
