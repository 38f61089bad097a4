"""Sides a of contacts as curves: contact constraints in their order along the mesh, and the arc length."""

from dataclasses import dataclass

import numpy as np

from contact_dd.drawing import shapes
from contact_dd.drawing.carried import carried, pressing

DIRECTION = (
    "from left to right, steep sides upwards, closed ones counter-clockwise from the right"
)


@dataclass
class Side:
    """Pressures and gaps of a contact along its side a."""

    pieces: list
    """Of each piece the rows in their order, and the arc length of each."""
    pressure: np.ndarray
    status: np.ndarray
    shear: np.ndarray | None
    """The tangential force over area along the normal turned by 90°, where there is friction."""


def sides_of(result):
    """The sides of all contacts that have conditions; none in space, where they are surfaces."""
    tables = {name: table for name, table in carried(pressing(result)).items() if len(table)}
    if not tables or result.is_in_space:
        return {}
    edges = boundary_edges(result, np.concatenate([table["node_a"] for table in tables.values()]))
    return {
        name: Side(
            curves_along(table["position"][:, :2], table["node_a"], edges),
            table["pressure"], table["status"], shear(table),
        )
        for name, table in tables.items()
    }


def shear(table):
    if "tangential_force" not in table.dtype.names:
        return None
    # The area is that of force and pressure, so that open conditions have none.
    force, pressure, forces, normal = (table[name] for name in ("force", "pressure", "tangential_force", "normal"))
    along = normal[:, 0] * forces[:, 1] - normal[:, 1] * forces[:, 0]
    return np.divide(along * pressure, force, out=np.zeros(len(force)), where=force > 0)


def boundary_edges(result, tags):
    """Pairs of node tags: edges of one cell only, between nodes that are among `tags`."""
    edges = []
    for kind, _, nodes in result.cells:
        for facet in shapes.CELLS[kind].facets:
            # With a node in the middle a facet is two edges.
            edges += [result.nodes[nodes[:, pair]] for pair in zip(facet, facet[1:])]
    edges = np.sort(np.concatenate(edges), axis=1)
    edges = edges[np.isin(edges, tags).all(axis=1)]
    edges, count = np.unique(edges, axis=0, return_counts=True)
    return edges[count == 1]


def curves_along(points, tags, edges):
    """The pieces of a side: rows in their order, and the arc length of each; a closed piece ends with its first row.

    Lengths continue from piece to piece by their distance."""
    pieces = [directed(points, piece) for piece in chains(tags, edges)]
    axis = np.ptp(points, axis=0).argmax()
    pieces.sort(key=lambda piece: points[piece[0], axis])
    found, end, length = [], None, 0.0
    for piece in pieces:
        steps = np.linalg.norm(np.diff(points[piece], axis=0), axis=1)
        if end is not None:
            length += np.linalg.norm(points[piece[0]] - points[end])
        way = length + np.concatenate([[0.0], np.cumsum(steps)])
        found.append((piece, way))
        end, length = piece[-1], way[-1]
    return found


def chains(tags, edges):
    """Rows of conditions whose nodes follow each other along the mesh; closed ones end where they begin."""
    row = {int(tag): k for k, tag in enumerate(tags)}
    near = {k: [] for k in row.values()}
    for a, b in edges:
        if a in row and b in row:
            near[row[a]].append(row[b])
            near[row[b]].append(row[a])
    left = set(near)
    # Ends of open pieces first; the remaining pieces are closed.
    for start in sorted(near, key=lambda k: (len(near[k]) > 1, k)):
        if start not in left:
            continue
        piece = [start]
        left.remove(start)
        while following := [k for k in near[piece[-1]] if k in left]:
            piece.append(following[0])
            left.remove(following[0])
        if len(piece) > 2 and start in near[piece[-1]]:
            piece.append(start)
        yield np.array(piece)


def directed(points, piece):
    """A piece in the DIRECTION of all."""
    at = points[piece]
    if len(piece) > 2 and piece[0] == piece[-1]:
        first = at[:-1, 0].argmax()
        area = np.sum(at[:-1, 0] * at[1:, 1] - at[1:, 0] * at[:-1, 1])
        turned = np.roll(piece[:-1], -first)
        closed = np.append(turned, turned[0])
        return closed if area > 0 else closed[::-1]
    chord = at[-1] - at[0]
    return piece if chord[np.abs(chord).argmax()] >= 0 else piece[::-1]
