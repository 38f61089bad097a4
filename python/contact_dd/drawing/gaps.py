"""Gaps that close: enlarged like all displacements, bodies that touch would be drawn over each other."""

import numpy as np

from contact_dd.drawing.carried import carried

# What of the size nobody sees.
INVISIBLE = 0.002

# Closed conditions of a contact that are looked at: of more, every so many.
MOST_LOOKED_AT = 100


def honest_scale(result):
    """The largest enlargement with which what is closed is drawn closed; infinite where any does."""
    tolerance = INVISIBLE * result.size
    least = np.inf
    for gap, approach in typical_gaps(result):
        # Drawn, the gap is gap − scale·approach, which may be as small as −tolerance or as large as tolerance.
        if abs(approach) > 1e-12 * result.size:
            least = min(least, (gap + np.copysign(tolerance, approach)) / approach)
    return max(least, 1.0)


def typical_gaps(result):
    """Of every closed contact of two bodies the gap that was meshed, and how far its sides have approached.

    Those of the condition with the median approach: near corners sides may part or meet aslant."""
    ends = result.outline[:, [0, 2]]
    lines = result.points[ends]
    order = np.argsort(result.tags, kind="stable")
    for table in carried(result.contacts).values():
        closed = np.flatnonzero(table["status"] > 0)
        found = []
        for k in closed[:: 1 + len(closed) // MOST_LOOKED_AT]:
            at, normal = table["position"][k, :2], table["normal"][k, :2]
            met = opposite(lines, at, normal, result.size)
            if met is None:
                continue
            own = order[np.searchsorted(result.tags, table["node_a"][k], sorter=order)]
            facet, part, gap = met
            a, b = result.deformation[ends[facet]]
            found.append(((result.deformation[own] - (1 - part) * a - part * b) @ normal, gap))
        if found:
            approach, gap = sorted(found)[len(found) // 2]
            yield gap, approach


def opposite(lines, at, normal, size):
    """The nearest line that the normal at a place meets and that faces it: its number, where on it, how far."""
    start, along = lines[:, 0] - at, lines[:, 1] - lines[:, 0]
    across = normal[0] * along[:, 1] - normal[1] * along[:, 0]
    with np.errstate(divide="ignore", invalid="ignore"):
        distance = (start[:, 0] * along[:, 1] - start[:, 1] * along[:, 0]) / across
        part = (start[:, 0] * normal[1] - start[:, 1] * normal[0]) / across
    # Cells lie to the left of their facets: what faces the normal runs from its left to its right.
    faces = (across < -0.2 * np.linalg.norm(along, axis=1)) & (part > -1e-6) & (part < 1 + 1e-6)
    found = np.flatnonzero(faces & (distance > -0.1 * size))
    if len(found) == 0:
        return None
    nearest = found[np.abs(distance[found]).argmin()]
    return nearest, part[nearest], distance[nearest]
