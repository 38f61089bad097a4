"""Ordinates along contacts: pressures on the sides with their largest values, and sticking and slipping parts."""

import numpy as np
from matplotlib.collections import LineCollection
from matplotlib.patches import PathPatch
from matplotlib.path import Path

from contact_dd.drawing.units import in_units

RED = "#d6202c"
# Where a contact with friction is closed, by its status.
FRICTION = {1: ("#1746a2", "sticks"), 2: ("#ff9f1c", "slips")}
# Pressures are hatched on white: red would turn the colours of the stress under it brown.
BAND = {"fc": (1, 1, 1, 0.5), "ec": RED, "hatch": "//////", "lw": 0}
# Most contacts whose largest pressure is written beside it, one by one.
MOST_LABELS = 6
# The share of a panel's width in which a number would reach over its edge.
AT_EDGE = 0.08


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
    """Lines along sticking and slipping parts, up to the middle between neighbours."""
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
        tip = side.tips(length)[k]
        across = (tip[0] - axes.get_xlim()[0]) / np.ptp(axes.get_xlim())
        grows = "left" if across < AT_EDGE else "right" if across > 1 - AT_EDGE else "center"
        axes.annotate(
            f"{shown:.3g} {prefixed}", tip, xytext=8 * side.normal[k], textcoords="offset points",
            ha=grows, va="center", fontsize=8, color=RED,
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
