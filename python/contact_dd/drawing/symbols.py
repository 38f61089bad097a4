"""Symbols of supports and loads: of many nodes those of a few that are spread over them, of one size on paper."""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from matplotlib.collections import PathCollection
from matplotlib.lines import Line2D
from matplotlib.path import Path
from matplotlib.patheffects import withStroke
from matplotlib.transforms import Affine2D

# Most symbols of a kind, and the least distance between two of them over the size of what is shown, in the plane and in
# space, where supports hide stresses.
MOST, APART, APART_IN_SPACE = 20, 0.045, 0.12
# Colours: of supports, of loads and prescribed motions, and between lines.
HELD, GIVEN, PAPER = "#222222", "#a3159b", "#ffffff"
# In legends: of a support that leaves displacements across its axis free.
ROLLER = "roller, held along its axis"
# Height of triangles, and lengths of arrows (points).
TALL, SHORTEST, LONGEST, OF_BODY = 8.0, 13.0, 24.0, 30.0
# Arrows at nodes this near to an edge, over the size of a panel, reach beyond it; free room there (points).
AT_EDGE, FREE_BELOW = 0.05, 8.0
# Cosine of the angle to the eye above which a direction is drawn as a ring.
TO_EYE = 0.97
# Cosine of the angle to a load down to which another one isn't opposite to it.
OPPOSITE = -0.5
# Length of the mean of the normals around a node below which it is at a corner.
CORNER = 0.95


@dataclass
class Paper:
    """Where nodes are on paper, and the outward normals at those on the surface (0 elsewhere); `frame` takes directions
    in space to paper, of which a part of this size is shown; `areas` says how much of a surface between given nodes
    belongs to each of them, where that is known."""

    places: np.ndarray
    normals: np.ndarray
    frame: np.ndarray
    size: float
    areas: Callable[[np.ndarray], np.ndarray] | None = None

    def is_in_space(self):
        return self.frame.shape[1] == 3

    def spread(self, rows, apart=APART, taken=()):
        """At most MOST of these nodes, far enough from each other and from those `taken`, corners last."""
        rows = np.asarray(rows, dtype=int)
        for other in taken:
            rows = rows[np.linalg.norm(self.places[rows] - self.places[other], axis=1) >= apart * self.size]
        is_corner = np.linalg.norm(self.normals[rows], axis=1) < CORNER
        rows = rows[np.argsort(is_corner, kind="stable")]
        apart = apart * self.size
        while True:
            chosen, left = [], rows
            while len(left) and len(chosen) <= MOST:
                chosen.append(left[0])
                left = left[np.linalg.norm(self.places[left] - self.places[left[0]], axis=1) >= apart]
            if len(chosen) <= MOST:
                return np.array(chosen, dtype=int)
            apart *= 1.25

    def direction(self, axis):
        """A direction on paper; none for one to the eye."""
        onto = self.frame @ axis
        length = np.linalg.norm(onto)
        return onto / length if length**2 > (1 - TO_EYE**2) * (axis @ axis) else None


TRIANGLE = [(0, 0), (-0.55, -1), (0.55, -1), (0, 0)]
# Without direction: a ring with its middle, as of an arrow that is seen from its end.
RING = Path.circle((0, 0), 0.45 * TALL)
# Lines under a triangle: those of a roller, and those of a fixed support.
ROLLED = [[(-0.6, -1.3), (0.6, -1.3)]]
FIXED = [[(-0.75, -1), (0.75, -1)], *([(x, -1), (x - 0.25, -1.35)] for x in (-0.5, -0.1, 0.3, 0.7))]
ZIGZAG = [[(0, 0), (0, -0.25), (-0.35, -0.4), (0.35, -0.65), (-0.35, -0.9), (0.35, -1.15), (0, -1.3), (0, -1.55)],
          [(-0.5, -1.55), (0.5, -1.55)]]


def turned(lines, outward, size):
    """A path of lines, in which −y becomes the direction outward."""
    x, y = outward
    points = np.concatenate(lines) @ np.array([[-y, x], [-x, -y]]) * size
    starts = np.cumsum([0, *(len(line) for line in lines)])[:-1]
    codes = np.full(len(points), Path.LINETO)
    codes[starts] = Path.MOVETO
    return Path(points, codes)


def arrow(direction, length, ends_here):
    """The outline of an arrow whose tip is at the node, or that begins there."""
    head, half, shaft = 6.0, 3.0, 0.8
    outline = np.array([(0, 0), (-half, -head), (-shaft, -head), (-shaft, -length), (shaft, -length), (shaft, -head),
                        (half, -head), (0, 0)])
    if not ends_here:
        outline[:, 1] += length
    return turned([outline], -np.asarray(direction), 1.0)


def in_legend():
    """The outline of an arrow to the right around its middle."""
    outline = arrow((1, 0), 20.0, False)
    return Path(outline.vertices - (10, 0), outline.codes)


def put(axes, paths, places, face, edge, width, zorder):
    """Paths in points around places of the axes."""
    if not paths:
        return
    drawn = PathCollection(paths, offsets=places, offset_transform=axes.transData, facecolors=face, edgecolors=edge,
                           linewidths=width, zorder=zorder, clip_on=False)
    drawn.set_transform(Affine2D().scale(1 / 72) + axes.figure.dpi_scale_trans)
    drawn.set_path_effects([withStroke(linewidth=width + 1.4, foreground=PAPER)])
    axes.add_collection(drawn, autolim=False)


def draw_supports(axes, paper, supports):
    """Triangles at supported nodes: fixed where all directions are held, else one on rollers along each one that is.
    Returns the supports that are drawn."""
    groups = {}
    for support in supports:
        groups.setdefault((len(support.axes), support.is_moved, support.is_spring), []).append(support)
    # In space faces come first, of whose edges some are seen without symbols of their own, in the plane corners.
    apart = APART_IN_SPACE if paper.is_in_space() else APART
    taken, drawn = [], []
    for (_, is_moved, _), group in sorted(groups.items(), reverse=not paper.is_in_space(), key=lambda item: item[0]):
        by_node = {support.node: support for support in group}
        paths, faces, places = [], [], []
        chosen = paper.spread(sorted(by_node), apart, taken)
        taken += chosen.tolist()
        drawn += [by_node[row] for row in chosen.tolist()]
        for row in chosen:
            for shape, face in glyphs(paper, by_node[row]):
                paths.append(shape)
                faces.append(face)
                places.append(paper.places[row])
        put(axes, paths, places, faces, GIVEN if is_moved else HELD, 0.9, 6)
    return drawn


def glyphs(paper, support):
    """The symbols of a support, each with its colour inside."""
    normal = paper.normals[support.node]
    if support.is_spring:
        axes, under, filled = support.axes, None, "none"
    elif len(support.axes) == paper.frame.shape[1]:
        outward = normal if np.linalg.norm(normal) > 0.1 else -np.eye(len(normal))[-1]
        axes, under, filled = [outward], FIXED, HELD
    else:
        axes, under, filled = support.axes, ROLLED, PAPER
    for axis in axes:
        outward = paper.direction(-axis if outward_of(paper, support.node, axis) < 0 else axis)
        if outward is None:
            yield RING, PAPER
        elif under is None:
            yield turned(ZIGZAG, outward, TALL), filled
        else:
            face = GIVEN if support.is_moved else filled
            yield turned([TRIANGLE, *under], outward, TALL), face


def outward_of(paper, node, axis):
    """Whether an axis points out of the body at a node, as a number above or below 0; along the surface downwards or to
    the left is outward."""
    along = paper.normals[node] @ axis
    return along if abs(along) > 0.2 else -axis.sum()


def draw_loads(axes, paper, nodes, forces):
    """Arrows at loaded nodes, the longer the larger the load is around them, by area where that is known."""
    if len(nodes) == 0:
        return
    # Opposite loads have arrows of their own: of both sides of a cut neither is left out.
    is_along = forces @ forces[0] > OPPOSITE * np.linalg.norm(forces, axis=1) * np.linalg.norm(forces[0])
    areas = paper.areas(nodes) if paper.areas else np.zeros(len(nodes))
    found = [spread_load(paper, nodes[of], forces[of], areas[of]) for of in (is_along, ~is_along) if of.any()]
    chosen, force, size = (np.concatenate(part) for part in zip(*found, strict=True))
    paths, places = [], []
    for node, pull, relative in zip(chosen, force, np.sqrt(size / max(size.max(), 1e-300)), strict=True):
        direction = paper.direction(pull)
        pushes = paper.normals[node] @ pull <= 0
        length = SHORTEST + (LONGEST - SHORTEST) * relative
        paths.append(RING if direction is None else arrow(direction, length, pushes))
        places.append(paper.places[node])
    put(axes, paths, places, GIVEN, GIVEN, 0.3, 7)


def spread_load(paper, nodes, forces, areas):
    """Of loaded nodes a few that are spread over them, their forces, and how large the load is around each."""
    chosen = paper.spread(nodes)
    row_of = {int(node): k for k, node in enumerate(nodes)}
    away = np.linalg.norm(paper.places[nodes][:, None] - paper.places[chosen], axis=2)
    nearest = away.argmin(axis=1)
    share = np.zeros((len(chosen), forces.shape[1]))
    np.add.at(share, nearest, forces)
    size = np.linalg.norm(share, axis=1)
    area = np.bincount(nearest, areas, len(chosen))
    # Point forces have none.
    size = size / area if (area > 0).all() else size
    return chosen, forces[[row_of[int(node)] for node in chosen]], size


def ends(paper, conditions, length):
    """Where arrows of this length at loaded nodes end that is no node."""
    found = []
    for node, force in zip(conditions.nodes, conditions.forces, strict=True):
        if (direction := paper.direction(force)) is not None:
            pushes = paper.normals[node] @ force <= 0
            found.append(paper.places[node] + (-length if pushes else length) * direction)
    return np.array(found).reshape(-1, 2)


def below(conditions, moved, normals, panels):
    """How far arrows of loads reach below the panels, into the room of the scale (inches)."""
    nodes, forces = conditions.nodes, conditions.forces
    if len(nodes) == 0:
        return 0.0
    up = forces[:, 1] / np.maximum(np.linalg.norm(forces, axis=1), 1e-300)
    pushes = (normals[nodes] * forces).sum(axis=1) <= 0
    places = moved[nodes]
    lowest = [np.all((places >= low) & (places <= high), axis=1) & (places[:, 1] < low[1] + AT_EDGE * max(high - low))
              for low, high in panels]
    reach = np.where(pushes, up, -up)[np.any(lowest, axis=0)].max(initial=0.0)
    return max(LONGEST * reach - FREE_BELOW, 0.0) / 72


def draw_bodies(axes, paper, centres, forces):
    """Arrows in the middle of bodies with a body force; of many bodies, some that are far from each other."""
    there = Paper(centres, np.ones((len(centres), 1)), paper.frame, paper.size)
    chosen = there.spread(np.arange(len(centres)))
    directions = [paper.direction(forces[k]) for k in chosen]
    paths = [RING if one is None else arrow(one, OF_BODY, True) for one in directions]
    put(axes, paths, centres[chosen], PAPER, GIVEN, 1.2, 7)


def draw(axes, paper, conditions):
    """Symbols of supports and loads. Returns the supports that have one, and the loads."""
    drawn = draw_supports(axes, paper, conditions.supports)
    draw_loads(axes, paper, conditions.nodes, conditions.forces)
    forces = np.array([force for _, force in conditions.bodies]).reshape(-1, paper.frame.shape[1])
    draw_bodies(axes, paper, conditions.centres()[:, : paper.frame.shape[1]] @ paper.frame.T, forces)
    return replace(conditions, supports=drawn)


def entries(conditions, dimension):
    """Legend of the symbols."""
    found = []

    def add(marker, face, edge, words, size=7):
        style = {"ls": "", "marker": marker, "ms": size, "mfc": face, "mec": edge}
        found.append(Line2D([], [], label=words, **style))

    ordinary = [support for support in conditions.supports if not support.is_spring]
    if any(len(one.axes) == dimension and not one.is_moved for one in ordinary):
        add("^", HELD, HELD, "fixed")
    if any(len(one.axes) < dimension and not one.is_moved for one in ordinary):
        add("^", PAPER, HELD, ROLLER)
    if any(one.is_moved for one in ordinary):
        add("^", GIVEN, GIVEN, "prescribed displacement")
    if any(one.is_spring for one in conditions.supports):
        add("$\\wr$", HELD, HELD, "spring")
    if len(conditions.nodes):
        add(in_legend(), GIVEN, GIVEN, "load", 18)
    if conditions.bodies:
        add(in_legend(), PAPER, GIVEN, "body force", 18)
    return found
