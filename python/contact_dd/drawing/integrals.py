"""Integrals over cells: of shape functions, which uniform body forces are shared out by, and of stresses."""

from dataclasses import dataclass
from functools import cache
from itertools import product

import numpy as np

SQUARE = [(0, 0), (1, 0), (1, 1), (0, 1)]
TRIANGLE = [(0, 0), (1, 0), (0, 1)]
TETRAHEDRON = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]
CUBE = [(*corner, z) for z in (0, 1) for corner in SQUARE]
AROUND = [(0, 1), (1, 2), (2, 3), (3, 0)]
OF_CUBE = [*AROUND, *((a + 4, b + 4) for a, b in AROUND), *((k, k + 4) for k in range(4))]
OF_TETRAHEDRON = [(0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)]
MIDDLES = [(0, 0.5, 0.5), (1, 0.5, 0.5), (0.5, 0, 0.5), (0.5, 1, 0.5), (0.5, 0.5, 0), (0.5, 0.5, 1), (0.5, 0.5, 0.5)]


def halfway(corners, edges):
    """Corners, and the middles of edges behind them."""
    return [*corners, *(tuple((np.array(corners[a]) + corners[b]) / 2) for a, b in edges)]


# The nodes of the reference cell, by VTK's number of the kind of cells.
NODES = {
    5: TRIANGLE, 22: halfway(TRIANGLE, [(0, 1), (1, 2), (2, 0)]),
    9: SQUARE, 23: halfway(SQUARE, AROUND), 28: [*halfway(SQUARE, AROUND), (0.5, 0.5)],
    10: TETRAHEDRON, 24: halfway(TETRAHEDRON, OF_TETRAHEDRON),
    12: CUBE, 25: halfway(CUBE, OF_CUBE), 29: [*halfway(CUBE, OF_CUBE), *MIDDLES],
}
SIMPLICES = (5, 22, 10, 24)
SERENDIPITY = (23, 25)


@dataclass
class Rule:
    """Shape functions and their derivatives at the points of a rule of integration, with the points' weights."""

    values: np.ndarray
    slopes: np.ndarray
    weights: np.ndarray


@cache
def rule_of(kind):
    """The integration rule for all cells of a kind."""
    at, weights = points_of(kind, len(NODES[kind][0]))
    return Rule(*shapes(kind, at), weights)


def shapes(kind, at):
    """Shape functions of a kind of cells and their derivatives at points of its reference cell, (points, nodes) and
    (points, nodes, d): sums of monomials, each 1 at its node and 0 at the others."""
    nodes = np.array(NODES[kind], dtype=float)
    dimension = nodes.shape[1]
    is_linear = len(nodes) <= 2**dimension
    all_powers = product(range(2 if is_linear else 3), repeat=dimension)
    powers = np.array([one for one in all_powers if is_used(kind, one, is_linear)])
    factors = np.linalg.inv(np.prod(nodes[:, None] ** powers, axis=2))
    slopes = []
    for k in range(dimension):
        less = powers.copy()
        less[:, k] = np.maximum(less[:, k] - 1, 0)
        slopes.append(powers[:, k] * np.prod(at[:, None] ** less, axis=2) @ factors)
    return np.prod(at[:, None] ** powers, axis=2) @ factors, np.stack(slopes, axis=2)


def is_used(kind, powers, is_linear):
    if kind in SIMPLICES:
        return sum(powers) <= (1 if is_linear else 2)
    return kind not in SERENDIPITY or powers.count(2) <= 1


def points_of(kind, dimension):
    """Gauss' points; those of simplices lie closer towards one corner, to which a square or a cube collapses."""
    x, w = np.polynomial.legendre.leggauss(4)
    x, w = (x + 1) / 2, w / 2
    at = np.array(list(product(x, repeat=dimension)))
    weights = np.prod(list(product(w, repeat=dimension)), axis=1)
    if kind in SIMPLICES:
        for k in range(1, dimension):
            weights = weights * (1 - at[:, k - 1]) ** (dimension - k)
        for k in range(1, dimension):
            at[:, k] *= 1 - at[:, :k].sum(axis=1)
    return at, weights


@dataclass
class Integrals:
    """Of the cells of one kind, for each cell and node: the integral of the shape function, and the force that holds a
    stress in balance."""

    shares: np.ndarray
    forces: np.ndarray | None


def integrals(kind, corners, stress=None, is_around_axis=False):
    """Integrals of cells whose nodes are at `corners`, (cells, nodes, d), of stresses at nodes, XX YY ZZ XY YZ XZ."""
    rule = rule_of(kind)
    dimension = corners.shape[2]
    jacobian = np.einsum("cnd,qnk->cqdk", corners, rule.slopes)
    volume = np.abs(np.linalg.det(jacobian)) * rule.weights
    if is_around_axis:
        radius = np.einsum("qn,cn->cq", rule.values, corners[..., 0])
        volume = volume * 2 * np.pi * radius
    shares = np.einsum("cq,qn->cn", volume, rule.values)
    if stress is None:
        return Integrals(shares, None)
    gradients = np.einsum("qnk,cqkd->cqnd", rule.slopes, np.linalg.inv(jacobian))
    at_points = np.einsum("qn,cns->cqs", rule.values, stress)
    tensor = at_points[..., [[0, 3, 5], [3, 1, 4], [5, 4, 2]]][..., :dimension, :dimension]
    forces = np.einsum("cq,cqnd,cqde->cne", volume, gradients, tensor)
    if is_around_axis:
        hoop = at_points[..., 2] * volume / np.maximum(radius, 1e-300)
        forces[..., 0] += np.einsum("cq,qn->cn", hoop, rule.values)
    return Integrals(shares, forces)
