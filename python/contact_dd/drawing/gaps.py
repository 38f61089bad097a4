"""Gaps in pictures: enlarged displacements would make closed, and even open ones, look like overlaps."""

import numpy as np

from contact_dd.drawing.carried import carried

# Part of the size that can't be seen.
INVISIBLE = 0.002

# Closed conditions of a contact that are looked at: of more, every so many.
MOST_LOOKED_AT = 100


def honest_scale(result):
    """The largest enlargement at which closed contacts look closed and open ones don't look like overlaps; infinite
    without a limit."""
    tolerance = INVISIBLE * result.size
    least = np.inf
    closed, still_open = typical_gaps(result)
    for gap, approach in closed:
        # Drawn, the gap is gap − scale·approach, which may be as small as −tolerance or as large as tolerance.
        if abs(approach) > 1e-12 * result.size:
            least = min(least, (gap + np.copysign(tolerance, approach)) / approach)
    for gap, approach in still_open:
        if approach > 1e-12 * result.size:
            least = min(least, (gap + tolerance) / approach)
    return max(least, 1.0)


def typical_gaps(result):
    """Of every contact of two bodies the gap that was meshed, and how far its sides have approached: where it is closed
    and where it is open.

    Those of the condition with the median approach where it is closed, as near corners sides may part or meet aslant;
    those of the one that would overlap first where it is open."""
    ends = result.outline[:, [0, 2]]
    lines = result.points[ends]
    order = np.argsort(result.tags, kind="stable")

    def gaps(table, rows):
        for k in rows[:: 1 + len(rows) // MOST_LOOKED_AT]:
            at, normal = table["position"][k, :2], table["normal"][k, :2]
            met = opposite(lines, at, normal, result.size)
            if met is None:
                continue
            own = order[np.searchsorted(result.tags, table["node_a"][k], sorter=order)]
            facet, part, gap = met
            a, b = result.deformation[ends[facet]]
            yield (result.deformation[own] - (1 - part) * a - part * b) @ normal, gap

    closed, still_open = [], []
    for table in carried(result.contacts).values():
        if found := sorted(gaps(table, np.flatnonzero(table["status"] > 0))):
            approach, gap = found[len(found) // 2]
            closed.append((gap, approach))
        still_open += [(gap, approach) for approach, gap in gaps(table, np.flatnonzero(table["status"] == 0))]
    return closed, still_open


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
