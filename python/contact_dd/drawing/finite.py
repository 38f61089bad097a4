"""Finite numbers, which alone can be drawn: those of a run that failed may not be."""

import numpy as np

from contact_dd.errors import InputError


def check_finite(result):
    """Raises `InputError` where a place, a displacement, a stress or a pressure isn't finite."""
    at_nodes = {"place": result.points, "displacement": result.displacement, "stress": result.stress}
    for what, values in at_nodes.items():
        check(result, what, values, result.nodes)
    for name, table in result.contacts.items():
        for column in ("position", "normal", "pressure"):
            check(result, f"{column} of contact {name!r}", table[column], table["node_a"])


def check(result, what, values, nodes):
    is_bad = ~np.isfinite(values).all(axis=tuple(range(1, values.ndim)))
    if is_bad.any():
        raise InputError(
            f"{result.path}: in step {result.step} the {what} at node {nodes[is_bad.argmax()]} isn't finite, which "
            "can't be drawn; expected the result of a run that ended well"
        )
