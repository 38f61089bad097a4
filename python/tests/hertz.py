"""Two cylinders after Hertz: the exact stress of the built-in scene, and the error of a result."""

import numpy as np

YOUNG, POISSON, A2 = 200.0, 0.3, 1.456 / np.pi


def exact(x, y):
    """The stress of Hertz's half plane, xx, yy, xy."""
    z = -y
    s = A2 - x**2 + z**2
    root = np.sqrt(s**2 + 4 * x**2 * z**2)
    m, n = np.sqrt((root + s) / 2), np.sqrt(np.maximum(root - s, 0) / 2)
    factor = -20 / 1.456
    xx = m * (1 + (z**2 + n**2) / root) - 2 * z
    yy = m * (1 - (z**2 + n**2) / root)
    return factor * np.array([xx, yy, -n * (m**2 - z**2) / root])


def true_error(result):
    """The stress' error relative to the exact stress, in the energy norm, integrated over each cell cut into 16."""
    (cells,) = result.cells
    assert cells.kind == 22
    at, u = result.points[cells.nodes[:, :3], :2], result.displacement[cells.nodes, :2]
    area = np.cross(at[:, 1] - at[:, 0], at[:, 2] - at[:, 0]) / 2
    slopes = np.linalg.inv(np.concatenate([at, np.ones((len(at), 3, 1))], axis=2))[:, :2].transpose(0, 2, 1)
    c = YOUNG / ((1 + POISSON) * (1 - 2 * POISSON))
    stiffness = c * np.array([[1 - POISSON, POISSON, 0], [POISSON, 1 - POISSON, 0], [0, 0, (1 - 2 * POISSON) / 2]])
    compliance = np.linalg.inv(stiffness)
    n = 4
    small = [(i + 1 / 3, j + 1 / 3) for i in range(n) for j in range(n - i)]
    small += [(i + 2 / 3, j + 2 / 3) for i in range(n - 1) for j in range(n - 1 - i)]
    error = norm = 0.0
    for i, j in small:
        b, c = i / n, j / n
        a = 1 - b - c
        of = [(4 * a - 1, 0, 0), (0, 4 * b - 1, 0), (0, 0, 4 * c - 1)]
        of += [(4 * b, 4 * a, 0), (0, 4 * c, 4 * b), (4 * c, 0, 4 * a)]
        gradient = np.einsum("ck,nkd,nce->nde", np.array(of), slopes, u)
        strain = np.stack([gradient[:, 0, 0], gradient[:, 1, 1], gradient[:, 0, 1] + gradient[:, 1, 0]], axis=1)
        x, y = np.einsum("k,nkd->dn", np.array([a, b, c]), at)
        sigma = exact(x, y).T
        off = strain @ stiffness - sigma
        error += (area / len(small) * np.einsum("ni,ij,nj->n", off, compliance, off)).sum()
        norm += (area / len(small) * np.einsum("ni,ij,nj->n", sigma, compliance, sigma)).sum()
    return np.sqrt(error / norm)
