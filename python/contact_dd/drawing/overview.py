"""The picture to look at first: the deformed shape by von Mises stress, contact pressures on it."""

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.colors import PowerNorm
from matplotlib.lines import Line2D
from matplotlib.patches import Patch, Rectangle
from matplotlib.patheffects import withStroke
from matplotlib.tri import Triangulation

from contact_dd.drawing import symbols
from contact_dd.drawing.canvas import deformation_of, directions, lines, scale_bar
from contact_dd.drawing.conditions import conditions_of
from contact_dd.drawing.contact import pressed_sides
from contact_dd.drawing.obstacle import draw_obstacles
from contact_dd.drawing.obstacle import entries as of_obstacles
from contact_dd.drawing.ordinates import BAND, FRICTION, labels, pressures, stick_and_slip
from contact_dd.drawing.plane import von_mises
from contact_dd.drawing.units import in_units

DASHES = (0, (5, 3))

# Where contacts press within so small a part of the size, a second panel shows that part.
SMALL = 1 / 6

# Share of the size below which the first panel shows the surroundings only, and their width over that of the part: a
# panel of everything would be a plain area.
SMALLER, SURROUNDINGS = 1 / 12, 7.0

# Width of that part over the width of what presses.
AROUND = 1.8

# The longest ordinate of a pressure over the size of a panel.
LONGEST = 0.09

# Width of one, two and three panels together (inches).
WIDTHS = (6.4, 7.6, 9.6)

# Around panels (inches); below them the scale, and a line for every few entries of the legend.
LEFT, BETWEEN, RIGHT, BELOW, ABOVE = 0.35, 0.3, 0.85, 0.64, 0.82
OF_LINE = 0.19
# A figure in which title and legend have room, and one from which on three entries of the legend have it beside each
# other (inches).
NARROWEST, WIDE = 5.6, 6.6

# Where all but a hundredth of the first panel has less than this part of the largest colour, colours go with the
# square root of the stress: it would be a plain area.
DULL = 0.1
# The axis that bodies are turned around.
AXIS = {"color": "k", "lw": 0.8, "ls": (0, (9, 2, 1, 2))}

# Room for a label behind the longest ordinate, over the size of a panel.
OF_LABEL = 0.05


def overview(result, scale):
    moved = result.deformed(scale)
    sides = pressed_sides(result, moved)
    part = part_that_presses(sides, result.size)
    conditions = conditions_of(result.result, np.unique(result.outline[result.outline >= 0]))
    panels = windows(part, moved, result.size, conditions) if part else [whole(result, moved, sides)]
    longest = LONGEST * max(panels[-1][1] - panels[-1][0])

    mesh = Triangulation(*result.at_points(moved).T, result.triangles)
    values = von_mises(result.at_points(result.stress))
    colours, unit, values = colouring(mesh, values, panels, result.units.stress)

    has_moved = np.abs(moved - result.points).max() > 0.004 * result.size
    is_turned = result.result.plane == "axisymmetric"
    largest = max((side.pressure.max() for side in sides), default=0.0)
    seen, normals = seen_in(conditions, moved, panels), result.normals()
    key = entries(sides, largest, has_moved, is_turned, result.units.stress) + symbols.entries(seen, 2)
    down = symbols.below(conditions, moved, normals, panels)
    figure, all_axes, of_colours = layout(panels, len(key), down)
    for axes, (low, high) in zip(all_axes, panels):
        axes.tripcolor(mesh, values, shading="gouraud", cmap=colours.cmap, norm=colours.norm)
        size = max(high - low)
        draw_obstacles(axes, sides, scale, size)
        if is_turned:
            axes.axvline(0, **AXIS)
        if has_moved:
            lines(axes, result.points, result.outline, colors="0.45", linewidths=0.6, linestyles=DASHES)
        lines(axes, moved, result.outline, colors="k", linewidths=0.9)
        axes.set_xlim(low[0], high[0])
        axes.set_ylim(low[1], high[1])
        scale_bar(axes, high[0] - low[0], result.units, down)
        paper = symbols.Paper(moved, normals, np.eye(2), size, result.lengths)
        symbols.draw(axes, paper, seen_in(conditions, moved, [(low, high)]))
    directions(all_axes[0], "rz" if is_turned else "xy", down)
    for axes, (low, high) in zip(all_axes, panels[1:]):
        axes.add_patch(Rectangle(low, *(high - low), fill=False, ec="k", lw=1.0))
    if largest > 0:
        pressures(all_axes[-1], sides, longest / largest)
        stick_and_slip(all_axes[-1], sides)
        labels(all_axes[-1], sides, longest / largest, result.units.stress)
    of_largest = f", at most {values.max():.4g}" if colours.extend == "max" else ""
    figure.colorbar(colours, cax=of_colours, extend=colours.extend, label=f"von Mises stress [{unit}]{of_largest}")
    headings(figure, result, sides, scale)
    figure.legend(handles=key, loc="lower center", ncol=columns_of(figure.get_figwidth()), frameon=False, fontsize=9,
                  columnspacing=1.4)
    return figure


def colouring(mesh, values, panels, unit):
    """Colours of values, in units with a prefix, and the values in these."""
    highest = bound(mesh, values, panels[-1])
    (shown,), prefixed = in_units(np.array([highest]), unit)
    values = values * (shown / highest)
    is_dull = bound(mesh, values, panels[0]) < DULL * shown
    norm = PowerNorm(0.5, 0, shown) if is_dull else plt.Normalize(0, shown)
    colours = plt.cm.ScalarMappable(norm, "viridis")
    colours.extend = "max" if values.max() > 1.001 * shown else "neither"
    return colours, prefixed, values


def headings(figure, result, sides, scale):
    """The scene's title, and below it the description of the picture."""
    what = "Von Mises stress and contact pressure" if sides else "Von Mises stress"
    step = f"Step {result.step} of {result.steps}: " if result.steps > 1 else ""
    words = what[0].lower() + what[1:] if step else what
    title, tall = result.result.title, figure.get_figheight()
    figure.suptitle(title, y=1 - 0.1 / tall, va="top", fontsize=12, parse_math=False)
    below = 0.34 if title else 0.14
    figure.text(0.5, 1 - below / tall, f"{step}{words}, {deformation_of(result, scale)}", ha="center", va="top",
                fontsize=10)


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
    """A window on all bodies, or around a part that is very small."""
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


def layout(panels, entries, down):
    """Axes side by side, as wide as the shapes of the panels ask for, and those of the colours, above so many entries
    of a legend and, `down` from them (inches), the scale."""
    ratios = [(high - low)[0] / (high - low)[1] for low, high in panels]
    height = float(np.clip(WIDTHS[len(panels) - 1] / sum(ratios), 2.4, 5.2))
    widths = [height * ratio for ratio in ratios]
    needed = LEFT + sum(widths) + BETWEEN * len(panels) + RIGHT
    total = max(needed, NARROWEST)
    below = BELOW + down + OF_LINE * -(-entries // columns_of(total))
    tall = below + height + ABOVE
    figure = plt.figure(figsize=(total, tall))

    def place(x, width):
        return figure.add_axes((x / total, below / tall, width / total, height / tall))

    axes, x = [], LEFT + (total - needed) / 2
    for k, width in enumerate(widths):
        axes.append(place(x, width))
        axes[k].set_xticks([])
        axes[k].set_yticks([])
        axes[k].spines[:].set_visible(k > 0)
        x += width + BETWEEN
    return figure, axes, place(x, 0.16)


def columns_of(width):
    """Entries of a legend beside each other in a figure of this width."""
    return 3 if width > WIDE else 2


def entries(sides, largest, has_moved, is_turned, unit):
    """Legend of pressures, friction, deformation, obstacles and axes."""
    found = of_obstacles(sides)
    if is_turned:
        found.append(Line2D([], [], **AXIS, label="axis of rotation"))
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
