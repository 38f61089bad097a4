"""Contact conditions of a result along the sides that they belong to."""

from dataclasses import dataclass

import numpy as np

from contact_dd.drawing.carried import carried
from contact_dd.drawing.gaps import opposite

# Conditions of a contact that are looked at: of more, every so many.
MOST_LOOKED_AT = 20


@dataclass
class PressedSide:
    """Side a of a contact: its conditions, moved with it, and segments between neighbours."""

    foot: np.ndarray
    normal: np.ndarray
    pressure: np.ndarray
    segments: np.ndarray
    status: np.ndarray
    has_friction: bool
    gap: np.ndarray
    is_on_obstacle: bool
    """Whether it faces no body."""

    def tips(self, length):
        """Where ordinates along the normals end that are as long as the pressure times `length`."""
        return self.foot + length * self.pressure[:, None] * self.normal


def pressed_sides(result, moved):
    """The sides of all contacts that have conditions, at the places to which nodes have moved."""
    order = np.argsort(result.tags, kind="stable")
    sorted_tags = result.tags[order]
    middle = result.outline[:, 1]
    is_bent = middle >= 0
    edges = np.concatenate(
        [
            result.outline[~is_bent][:, [0, 2]],
            result.outline[is_bent][:, [0, 1]],
            result.outline[is_bent][:, [1, 2]],
        ]
    )
    edges = result.tags[edges]
    lines = result.points[result.outline[:, [0, 2]]]
    sides = []
    for table in carried(result.contacts).values():
        tags = table["node_a"]
        if len(tags) == 0:
            continue
        found = order[np.searchsorted(sorted_tags, tags).clip(max=len(order) - 1)]
        known = (result.tags[found] == tags)[:, None]
        foot = np.where(known, moved[found], table["position"][:, :2])
        sides.append(
            PressedSide(
                foot,
                table["normal"][:, :2],
                table["pressure"],
                along(edges, tags),
                table["status"],
                "slip" in table.dtype.names,
                table["gap"],
                not faces_a_body(table, lines, result.size),
            )
        )
    return sides


def faces_a_body(table, lines, size):
    """Whether another side lies before one of the conditions: an obstacle is none."""
    rows = range(0, len(table), 1 + len(table) // MOST_LOOKED_AT)
    places, normals = table["position"][:, :2], table["normal"][:, :2]
    return any(opposite(lines, places[k], normals[k], size) is not None for k in rows)


def along(edges, tags):
    """The pairs of rows whose nodes, by their tags, are the ends of an edge."""
    order = np.argsort(tags, kind="stable")
    rows = order[np.searchsorted(tags[order], edges).clip(max=len(order) - 1)]
    both = (tags[rows] == edges).all(axis=1)
    return np.unique(np.sort(rows[both], axis=1), axis=0)
