"""Contacts of which side b's nodes have the conditions."""

import numpy as np

from contact_dd.drawing.carried import carried

COLUMNS = [("node_a", "i8"), ("node_b", "i8"), ("normal", "f8", 3), ("pressure", "f8"), ("slip", "f8", 3)]


def table(rows):
    return np.array(rows, dtype=COLUMNS)


def test_the_nodes_with_conditions_are_those_of_side_a():
    mortar = table([(-1, 7, (0, 1, 0), 2.0, (3, 0, 0)), (-1, 8, (0, 1, 0), 0.0, (0, 0, 0))])
    other = table([(5, -1, (0, 1, 0), 2.0, (3, 0, 0)), (6, 9, (0, 1, 0), 1.0, (0, 0, 0))])
    found = carried({"mortar": mortar, "other": other})
    assert found["mortar"]["node_a"].tolist() == [7, 8]
    assert found["mortar"]["node_b"].tolist() == [-1, -1]
    assert found["mortar"]["normal"][0].tolist() == [0, -1, 0]
    assert found["mortar"]["slip"][0].tolist() == [-3, 0, 0]
    assert found["mortar"]["pressure"].tolist() == [2.0, 0.0]
    # What the caller has stays, and what has its conditions on side a is the same.
    assert mortar["node_a"].tolist() == [-1, -1]
    assert found["other"] is other
