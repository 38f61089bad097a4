"""Rigid obstacles, drawn as ground under the sides of their contacts."""

import numpy as np
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.patches import Patch

# Colours of the ground, and of its surface.
GROUND, SURFACE = "#cfcfcf", "#555555"
# Its thickness, how far it reaches beyond the sides, and the widest gap to it that is drawn, over the size of a panel.
THICK, BEYOND, FAR = 0.04, 0.06, 0.12


def draw_obstacles(axes, sides, scale, size):
    """Ground at the gaps that are left, enlarged like displacements."""
    for side in sides:
        if not side.is_on_obstacle:
            continue
        gap = scale * side.gap
        near = np.isfinite(gap) & (gap < FAR * size)
        surface = side.foot + np.where(near, gap, 0.0)[:, None] * side.normal
        drawn = side.segments[near[side.segments].all(axis=1)]
        ends = surface[np.concatenate([drawn, drawn[:, ::-1]])]
        is_last = np.bincount(drawn.ravel(), minlength=len(surface))[drawn.T.ravel()] == 1
        # Where the side goes on with another body the ground does, too.
        away = np.linalg.norm(ends[is_last, None, 0] - ends[None, is_last, 0], axis=2)
        is_last[is_last] = (away < BEYOND * size).sum(axis=1) == 1
        ends[is_last, 0] += BEYOND * size * unit(ends[is_last, 0] - ends[is_last, 1])
        # Each segment is there twice, and ends with its own longer end in one of them.
        first, second = np.split(ends, 2)
        lines = np.stack([first[:, 0], second[:, 0]], axis=1)
        under = lines + THICK * size * side.normal[drawn]
        ground = np.concatenate([lines, under[:, ::-1]], axis=1)
        axes.add_collection(PolyCollection(ground, fc=GROUND, ec=GROUND, lw=0.4, zorder=0.5))
        axes.add_collection(LineCollection(lines, colors=SURFACE, linewidths=1.4, zorder=0.6))


def unit(vectors):
    return vectors / np.linalg.norm(vectors, axis=1, keepdims=True)


def entries(sides):
    """Legend of obstacles."""
    there = any(side.is_on_obstacle for side in sides)
    return [Patch(fc=GROUND, ec=SURFACE, lw=0.8, label="rigid obstacle")] if there else []
