"""Pressures at the rims of contacts, where they may be singular."""

import numpy as np

from contact_dd.drawing.carried import carried, pressing
from contact_dd.drawing.sides import sides_of
from contact_dd.drawing.space import Solid

# Part of a contact's largest pressure by which that at the end of a side may leave the line through those at the next
# two nodes. Bounded pressures that leave it by more tend to another limit for each kind of cells; those of smooth
# contacts leave it by a hundredth on ten facets.
BENT = 0.05


def bent_at_rim(result):
    """The names of contacts whose largest pressure is at one of the last two nodes before an open end of a side, where
    pressures bend: it is the mesh's. In space none."""
    found = set()
    for name, side in {} if result.is_in_space else sides_of(result).items():
        largest = side.pressure.max(initial=0.0)
        for rows, _ in side.pieces:
            ends = [rows[:3], rows[::-1][:3]] if len(rows) > 2 and rows[0] != rows[-1] else []
            for first, second, third in (side.pressure[end] for end in ends):
                if max(first, second) >= largest > 0 and abs(first - 2 * second + third) > BENT * largest:
                    found.add(name)
    return found


def rim_pressures(result):
    """By the names of contacts the largest pressure at the rim of side a; 0 where it has none."""
    if result.is_in_space:
        solid = Solid(result)
        tables = {name: table for name, table in carried(pressing(result)).items() if len(table)}
        return {name: at_nodes(table, rim_of(result, solid.side(table)[0])) for name, table in tables.items()}
    found = {}
    for name, side in sides_of(result).items():
        open_ends = [rows[[0, -1]] for rows, _ in side.pieces if rows[0] != rows[-1] or len(rows) == 1]
        ends = np.concatenate(open_ends) if open_ends else np.zeros(0, dtype=int)
        found[name] = float(side.pressure[ends].max(initial=0.0))
    return found


def rim_of(result, faces):
    """The tags of nodes on edges of one face only."""
    if not faces:
        return np.zeros(0, dtype=int)
    edges = np.sort(np.concatenate([np.stack([face, np.roll(face, -1)], axis=1) for face in faces]), axis=1)
    edges, count = np.unique(edges, axis=0, return_counts=True)
    return result.nodes[np.unique(edges[count == 1])]


def at_nodes(table, tags):
    return float(table["pressure"][np.isin(table["node_a"], tags)].max(initial=0.0))
