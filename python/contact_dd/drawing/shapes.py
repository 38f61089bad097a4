"""Plane cells by VTK's number: shape functions, facets, and triangles to draw them by."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

# Most nodes of a cell.
MOST = 9


@dataclass
class Cell:
    """Shape functions at points (s, t), facets from corner to corner, and the reference cell."""

    values: Callable[[np.ndarray], np.ndarray]
    facets: list[tuple[int, ...]]
    is_triangle: bool
    is_linear: bool

    def pattern(self, steps):
        """Points (s, t) of the reference cell, and triangles between them."""
        n = 1 if self.is_linear else steps
        number, points = {}, []
        for j in range(n + 1):
            for i in range(n + 1 - (j if self.is_triangle else 0)):
                number[i, j] = len(points)
                points.append((i / n, j / n))
        triangles = []
        for i, j in number:
            a, b, c, d = (number.get((i + p, j + q)) for p, q in ((0, 0), (1, 0), (0, 1), (1, 1)))
            if b is not None and c is not None:
                triangles.append((a, b, c))
            if d is not None:
                triangles.append((b, d, c))
        return np.array(points), np.array(triangles)


def triangle3(at):
    s, t = at.T
    return np.stack([1 - s - t, s, t], axis=1)


def triangle6(at):
    a, b, c = triangle3(at).T
    corners = [a * (2 * a - 1), b * (2 * b - 1), c * (2 * c - 1)]
    return np.stack([*corners, 4 * a * b, 4 * b * c, 4 * c * a], axis=1)


def quad4(at):
    s, t = at.T
    return np.stack([(1 - s) * (1 - t), s * (1 - t), s * t, (1 - s) * t], axis=1)


def quad8(at):
    s, t = at.T
    edges = [4 * s * (1 - s) * (1 - t), 4 * t * (1 - t) * s, 4 * s * (1 - s) * t, 4 * t * (1 - t) * (1 - s)]
    corners = quad4(at).T
    less = [corner - (edges[k] + edges[k - 1]) / 2 for k, corner in enumerate(corners)]
    return np.stack([*less, *edges], axis=1)


def quad9(at):
    s, t = at.T
    middle = 16 * s * (1 - s) * t * (1 - t)
    eight = quad8(at).T
    corners = [corner + middle / 4 for corner in eight[:4]]
    edges = [edge - middle / 2 for edge in eight[4:]]
    return np.stack([*corners, *edges, middle], axis=1)


QUAD_EDGES = [(0, 4, 1), (1, 5, 2), (2, 6, 3), (3, 7, 0)]

CELLS = {
    5: Cell(triangle3, [(0, 1), (1, 2), (2, 0)], True, True),
    9: Cell(quad4, [(0, 1), (1, 2), (2, 3), (3, 0)], False, True),
    22: Cell(triangle6, [(0, 3, 1), (1, 4, 2), (2, 5, 0)], True, False),
    23: Cell(quad8, QUAD_EDGES, False, False),
    28: Cell(quad9, QUAD_EDGES, False, False),
}
