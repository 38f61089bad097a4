"""The picture to look at first: the deformed shape by von Mises stress, contact pressures on it."""

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.collections import LineCollection
from matplotlib.lines import Line2D
from matplotlib.patches import Patch, PathPatch, Rectangle
from matplotlib.path import Path
from matplotlib.patheffects import withStroke
from matplotlib.tri import Triangulation

from contact_dd.drawing import symbols
from contact_dd.drawing.canvas import deformation_of, lines, scale_bar
from contact_dd.drawing.conditions import conditions_of
from contact_dd.drawing.contact import pressed_sides
from contact_dd.drawing.plane import von_mises
from contact_dd.drawing.units import in_units

RED = "#d6202c"
# Where a contact with friction is closed, by its status.
FRICTION = {1: ("#1746a2", "sticks"), 2: ("#ff9f1c", "slips")}
DASHES = (0, (5, 3))

# Where contacts press within so small a part of the size, a second panel shows that part.
SMALL = 1 / 6

# Where it is smaller than this part of the size, the first panel shows what is around it, so many times as wide: all
# would be a plain area.
SMALLER, SURROUNDINGS = 1 / 12, 7.0

# Width of that part over the width of what presses.
AROUND = 1.8

# The longest ordinate of a pressure over the size of a panel.
LONGEST = 0.09

# Width of one, two and three panels together (inches).
WIDTHS = (6.4, 7.6, 9.6)

# Around panels (inches); below them the scale, and a line for every few entries of the legend.
LEFT, BETWEEN, RIGHT, BELOW, ABOVE = 0.35, 0.3, 0.85, 0.5, 0.62
IN_LINE, OF_LINE = 3, 0.19

# What presses is hatched on white: a coating of red would turn the stress under it brown.
BAND = {"fc": (1, 1, 1, 0.5), "ec": RED, "hatch": "//////", "lw": 0}
# Room for a label behind the longest ordinate, over the size of a panel.
OF_LABEL = 0.05

# Most contacts whose largest pressure is written beside it, one by one.
MOST_LABELS = 6


def overview(result, scale):
    moved = result.deformed(scale)
    sides = pressed_sides(result, moved)
    part = part_that_presses(sides, result.size)
    conditions = conditions_of(result.result, np.unique(result.outline[result.outline >= 0]))
    panels = windows(part, moved, result.size, conditions) if part else [whole(result, moved, sides)]
    longest = LONGEST * max(panels[-1][1] - panels[-1][0])

    mesh = Triangulation(*result.at_points(moved).T, result.triangles)
    values = von_mises(result.at_points(result.stress))
    highest = bound(mesh, values, panels[-1])
    (shown,), unit = in_units(np.array([highest]), result.units.stress)
    values = values * (shown / highest)

    has_moved = np.abs(moved - result.points).max() > 0.004 * result.size
    largest = max((side.pressure.max() for side in sides), default=0.0)
    seen, normals = seen_in(conditions, moved, panels), result.normals()
    key = entries(sides, largest, has_moved, result.units.stress) + symbols.entries(seen, 2)
    figure, all_axes, of_colours = layout(panels, BELOW + OF_LINE * -(-len(key) // IN_LINE))
    for axes, (low, high) in zip(all_axes, panels):
        colours = axes.tripcolor(mesh, values, shading="gouraud", cmap="viridis", vmin=0, vmax=shown)
        if has_moved:
            lines(axes, result.points, result.outline, colors="0.45", linewidths=0.6, linestyles=DASHES)
        lines(axes, moved, result.outline, colors="k", linewidths=0.9)
        axes.set_xlim(low[0], high[0])
        axes.set_ylim(low[1], high[1])
        scale_bar(axes, high[0] - low[0], result.units)
        paper = symbols.Paper(moved, normals, np.eye(2), max(high - low))
        symbols.draw(axes, paper, seen_in(conditions, moved, [(low, high)]))
    for axes, (low, high) in zip(all_axes, panels[1:]):
        axes.add_patch(Rectangle(low, *(high - low), fill=False, ec="k", lw=1.0))
    if largest > 0:
        pressures(all_axes[-1], sides, longest / largest)
        stick_and_slip(all_axes[-1], sides)
        labels(all_axes[-1], sides, longest / largest, result.units.stress)
    exceeded = "max" if values.max() > 1.001 * shown else "neither"
    of_largest = f", at most {values.max():.4g}" if exceeded == "max" else ""
    figure.colorbar(colours, cax=of_colours, extend=exceeded, label=f"von Mises stress [{unit}]{of_largest}")
    what = "Von Mises stress and contact pressure" if sides else "Von Mises stress"
    step = f"Step {result.step} of {result.steps}: " if result.steps > 1 else ""
    words = what[0].lower() + what[1:] if step else what
    title = f"{step}{words}, {deformation_of(result, scale)}"
    figure.suptitle(title, y=1 - 0.12 / figure.get_figheight(), va="top", fontsize=12)
    figure.legend(handles=key, loc="lower center", ncol=IN_LINE, frameon=False, fontsize=9, columnspacing=1.4)
    return figure


def within(places, panel):
    """Flags of the places within a panel."""
    low, high = panel
    return np.all((places >= low) & (places <= high), axis=1)


def seen_in(conditions, moved, panels):
    """The supports and loads within one of the panels."""
    nodes = [within(moved, panel) for panel in panels]
    bodies = [within(conditions.centres()[:, :2], panel) for panel in panels]
    return conditions.seen(np.any(nodes, axis=0), np.any(bodies, axis=0))


def whole(result, moved, sides):
    """A window on the bodies as they were and are, with the pressures on them."""
    largest = max((side.pressure.max() for side in sides), default=0.0)
    longest = (LONGEST + OF_LABEL) * max(np.ptp(moved, axis=0))
    tips = [side.tips(longest / largest) for side in sides] if largest > 0 else []
    return window([result.points, moved, *tips], 0.02)


def windows(part, moved, size, conditions):
    """Windows on a small part: around it, and on it alone; on all bodies before these where loads lie elsewhere."""
    around = surroundings(part, moved, size)
    driven = [support.node for support in conditions.supports if support.is_moved]
    loaded = moved[np.concatenate([conditions.nodes, np.array(driven, dtype=int)])]
    everything = [] if within(loaded, around).all() else [window([moved], 0.02)]
    return [*everything, around, part]


def surroundings(part, moved, size):
    """A window on all bodies, or where the part is very small on what is around it."""
    low, high = window([moved], 0.02)
    width = max(part[1] - part[0])
    if width > SMALLER * size:
        return low, high
    middle, half = (part[0] + part[1]) / 2, SURROUNDINGS * width / 2
    return np.maximum(low, middle - half), np.minimum(high, middle + half)


def window(places, margin):
    """The corners of a rectangle around all of `places`."""
    points = np.concatenate(places)
    low, high = points.min(axis=0), points.max(axis=0)
    around = margin * max(high - low)
    return low - around, high + around


def part_that_presses(sides, size):
    """The square around all that presses, where it is a small part of the size."""
    pressing = [side.foot[side.pressure > 0] for side in sides if side.pressure.max() > 0]
    if not pressing:
        return None
    low, high = window(pressing, 0.0)
    width = max(high - low)
    if not 0 < width < SMALL * size:
        return None
    middle, half = (low + high) / 2, AROUND * width / 2
    return middle - half, middle + half


def bound(mesh, values, panel):
    """The value that all but a hundredth of the panel's area stays below; twice one that is uniform."""
    corners = np.stack([mesh.x, mesh.y], axis=1)[mesh.triangles]
    middle = corners.mean(axis=1)
    inside = np.all((middle > panel[0]) & (middle < panel[1]), axis=1)
    u, v = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    area = np.abs(u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0])[inside]
    value = values[mesh.triangles[inside]].max(axis=1)
    order = np.argsort(value)
    share = np.cumsum(area[order]) / area.sum()
    found = value[order][min(np.searchsorted(share, 0.99), len(order) - 1)]
    return max(2 * found if np.ptp(value) < 1e-3 * found else found, 1e-300)


def layout(panels, below):
    """Axes side by side, as wide as the shapes of the panels ask for, and those of the colours."""
    ratios = [(high - low)[0] / (high - low)[1] for low, high in panels]
    height = float(np.clip(WIDTHS[len(panels) - 1] / sum(ratios), 2.4, 5.2))
    widths = [height * ratio for ratio in ratios]
    total = LEFT + sum(widths) + BETWEEN * len(panels) + RIGHT
    tall = below + height + ABOVE
    figure = plt.figure(figsize=(total, tall))

    def place(x, width):
        return figure.add_axes((x / total, below / tall, width / total, height / tall))

    axes, x = [], LEFT
    for k, width in enumerate(widths):
        axes.append(place(x, width))
        axes[k].set_xticks([])
        axes[k].set_yticks([])
        axes[k].spines[:].set_visible(k > 0)
        x += width + BETWEEN
    return figure, axes, place(x, 0.16)


def pressures(axes, sides, length):
    """Bands along closed contacts, as wide as the pressure times `length`, and open contacts in white."""
    for side in sides:
        tip = side.tips(length)
        a, b = side.segments.T
        closed = (side.pressure[a] > 0) | (side.pressure[b] > 0)
        a, b = a[closed], b[closed]
        shape = band(side.foot[a], tip[a], tip[b], side.foot[b])
        axes.add_patch(PathPatch(shape, **BAND))
        for ends in ([tip[a], tip[b]], [side.foot[a], side.foot[b]]):
            strokes(axes, ends, colors=RED, linewidths=1.1)
        a, b = side.segments[~closed].T
        for color, width in (("k", 2.4), ("w", 1.2)):
            strokes(axes, [side.foot[a], side.foot[b]], colors=color, linewidths=width)


def stick_and_slip(axes, sides):
    """Lines along what sticks and what slips, up to the middle between neighbours."""
    for side in sides:
        if not side.has_friction:
            continue
        ends = np.concatenate([side.segments, side.segments[:, ::-1]])
        own, middle = side.foot[ends[:, 0]], side.foot[ends].mean(axis=1)
        closed = side.status[ends[:, 0]] > 0
        strokes(axes, [own[closed], middle[closed]], colors="k", linewidths=4.2)
        for status, (color, _) in FRICTION.items():
            of_status = side.status[ends[:, 0]] == status
            strokes(axes, [own[of_status], middle[of_status]], colors=color, linewidths=2.8, zorder=3)


def strokes(axes, ends, **style):
    axes.add_collection(LineCollection(np.stack(ends, axis=1), capstyle="round", **style))


def labels(axes, sides, length, unit):
    """The largest pressure of each contact, or of all where there are many."""
    labelled = [side for side in sides if side.pressure.max() > 0]
    if len(labelled) > MOST_LABELS:
        labelled = [max(labelled, key=lambda side: side.pressure.max())]
    for side in labelled:
        k = middle_of_largest(side)
        (shown,), prefixed = in_units(side.pressure[k : k + 1], unit)
        axes.annotate(
            f"{shown:.3g} {prefixed}", side.tips(length)[k], xytext=8 * side.normal[k],
            textcoords="offset points", ha="center", va="center", fontsize=8, color=RED,
            bbox={"fc": "w", "ec": "none", "alpha": 0.85, "pad": 0.8}, zorder=8,
        )


def middle_of_largest(side):
    """Of the places where the pressure is largest, all but rounding, the one in their middle."""
    largest = np.flatnonzero(side.pressure > 0.999 * side.pressure.max())
    away = side.foot[largest] - side.foot[largest].mean(axis=0)
    return largest[np.linalg.norm(away, axis=1).argmin()]


def band(*corners):
    """One path of quadrilaterals that run the same way round, so that none is filled twice."""
    quads = np.stack(corners, axis=1)
    diagonals = quads[:, 2] - quads[:, 0], quads[:, 3] - quads[:, 1]
    clockwise = diagonals[0][:, 0] * diagonals[1][:, 1] < diagonals[0][:, 1] * diagonals[1][:, 0]
    quads[clockwise] = quads[clockwise, ::-1]
    closed = np.concatenate([quads, quads[:, :1]], axis=1)
    codes = [Path.MOVETO, Path.LINETO, Path.LINETO, Path.LINETO, Path.CLOSEPOLY]
    return Path(closed.reshape(-1, 2), np.tile(codes, len(quads)))


def entries(sides, largest, has_moved, unit):
    """Legend of pressures, friction and deformation."""
    found = []
    if has_moved:
        found.append(Line2D([], [], color="0.45", lw=0.8, ls=DASHES, label="undeformed"))
    if largest > 0:
        (shown,), unit = in_units(np.array([largest]), unit)
        found.append(Patch(**{**BAND, "lw": 1}, label=f"contact pressure, at most {shown:.3g} {unit}"))
    for status, (color, word) in FRICTION.items():
        if any(side.has_friction and (side.status == status).any() for side in sides):
            halo = [withStroke(linewidth=4.2, foreground="k")]
            found.append(Line2D([], [], color=color, lw=2.8, path_effects=halo, label=word))
    if any((side.pressure <= 0).any() for side in sides):
        halo = [withStroke(linewidth=2.6, foreground="k")]
        found.append(Line2D([], [], color="w", lw=1.2, path_effects=halo, label="open contact"))
    return found
