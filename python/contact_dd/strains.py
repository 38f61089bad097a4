"""Strains and stresses at points of cells, and the forces that hold them in balance, with the solver's own rules of
integration."""

from __future__ import annotations

from itertools import product
from typing import Any

import numpy as np
from numpy.typing import NDArray

from contact_dd.drawing.integrals import shapes

Floats = NDArray[np.float64]

TRIANGLES, QUADRILATERALS, TETRAHEDRA, HEXAHEDRA = (5, 22), (9, 23, 28), (10, 24), (12, 25, 29)
LINEAR = (5, 9, 10, 12)
# Kinds of cells with incompatible modes, where their material has them.
WITH_MODES = (9, 12)
# Kinds of cells that may have reduced integration, by their material.
WITH_REDUCED = (23, 25)


class Strained:
    """Cells of one kind at points of their reference cell: the strains that displacements make there."""

    def __init__(self, kind: int, corners: Floats, at: Floats, weights: Floats, is_around_axis: bool = False) -> None:
        self.values, slopes = shapes(kind, at)
        dimension = corners.shape[2]
        jacobian = np.einsum("cnd,qnk->cqdk", corners, slopes)
        determinant = np.linalg.det(jacobian)
        self.volume = np.abs(determinant) * weights
        """Weights of the points, (cells, points); around an axis of the whole ring."""
        gradients = np.einsum("qnk,cqkd->cqnd", slopes, np.linalg.inv(jacobian))
        self.operator = operator(gradients, 4 if is_around_axis else None)
        """B, (cells, points, components, displacements), which maps nodal displacements to strains."""
        if is_around_axis:
            radius = np.einsum("qn,cn->cq", self.values, corners[..., 0])
            self.operator[:, :, 2, ::2] = self.values / radius[..., None]
            self.volume *= 2 * np.pi * radius
        # ∂(1 − ξ²) with the Jacobian of the middle: J₀⁻ᵀ det J₀ / det J.
        slopes_of_middle: Floats = shapes(kind, np.full((1, dimension), 0.5))[1][0]
        middle = np.einsum("cnd,nk->cdk", corners, slopes_of_middle)
        cofactors = np.linalg.det(middle)[:, None, None] * np.linalg.inv(middle)
        modes = -4 * (2 * at - 1)[None, :, :, None] * cofactors[:, None] / determinant[..., None, None]
        self.modes = operator(modes, None)
        """The same of the amplitudes of incompatible modes."""


def operator(gradients: Floats, components: int | None) -> Floats:
    """Matrices from displacements to strains, of functions with these gradients, (cells, points, functions, d)."""
    cells, points, functions, dimension = gradients.shape
    components = components or (3 if dimension == 2 else 6)
    made = np.zeros((cells, points, components, functions, dimension))
    for a in range(dimension):
        made[:, :, a, :, a] = gradients[..., a]
        for b in range(a + 1, dimension):
            shear = 6 - a - b if components == 6 else components - 1
            made[:, :, shear, :, a] = gradients[..., b]
            made[:, :, shear, :, b] = gradients[..., a]
    return made.reshape(cells, points, components, functions * dimension)


def amplitudes(at_rule: Strained, stiffness: Floats, u: Floats) -> Floats:
    """The amplitudes of incompatible modes, by which the modes of each cell are in balance."""
    weighted = np.einsum("cq,cqvm,cvw->cqwm", at_rule.volume, at_rule.modes, stiffness)
    of_modes = np.einsum("cqwm,cqwn->cmn", weighted, at_rule.modes)
    of_nodes = np.einsum("cqwm,cqwn,cn->cm", weighted, at_rule.operator, u)
    found: Floats = -np.linalg.solve(of_modes, of_nodes[..., None])[..., 0]
    return found


def rule(kind: int, is_around_axis: bool = False, is_reduced: bool = False) -> tuple[Floats, Floats]:
    """The points and weights by which the solver integrates the stiffness of such cells."""
    if kind in QUADRILATERALS + HEXAHEDRA:
        dimension = 2 if kind in QUADRILATERALS else 3
        at, weight = np.polynomial.legendre.leggauss(2 if kind in LINEAR or is_reduced and kind in WITH_REDUCED else 3)
        points = grid((at + 1) / 2, dimension)
        return points, np.prod(grid(weight / 2, dimension), axis=1)
    if kind == 5:
        return orbit([(1 / 6, 1 / 6)], 2) if is_around_axis else (np.full((1, 2), 1 / 3), np.array([0.5]))
    if kind == 22:
        place, weight = (38 - 44 * 0.4**0.5) ** 0.5, (213125 - 53320 * 10**0.5) ** 0.5
        sign = np.array([1, -1])
        return orbit(list(zip((8 - 10**0.5 + sign * place) / 18, (620 + sign * weight) / 7440, strict=True)), 2)
    if kind == 10:
        return np.full((1, 3), 0.25), np.array([1 / 6])
    place = (1022 - 134 * 17**0.5) ** 0.5
    weight = ((1715161837 - 406006699 * 17**0.5) / 23101) ** 0.5 / 3120
    sign = np.array([1, -1])
    return orbit(list(zip((55 - 3 * 17**0.5 + sign * place) / 196, (0.125 + sign * weight) / 6, strict=True)), 3)


def orbit(parts: Any, dimension: int) -> tuple[Floats, Floats]:
    """Points at which all barycentric coordinates but one are the same, which part by part have a weight."""
    at = [[a + (k == axis) * (1 - (dimension + 1) * a) for k in range(dimension)]
          for a, _ in parts for axis in range(-1, dimension)]
    return np.array(at), np.repeat([weight for _, weight in parts], dimension + 1)


def grid(line: Floats, dimension: int) -> Floats:
    """All combinations of numbers, the first coordinate the fastest."""
    return np.array([point[::-1] for point in product(line, repeat=dimension)])
