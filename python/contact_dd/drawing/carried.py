"""Contacts as the side sees them whose nodes have the conditions."""


# Kinds of conditions whose forces are no pressures.
WITHOUT_PRESSURE = ("equation", "spring", "coupling", "pretension", "held pretension")


def pressing(result):
    """The contacts and ties that are there, by their names, without equations, couplings and pretensions."""
    kinds = {one["name"]: one.get("kind") for one in result.report["contacts"]}
    return {name: table for name, table in result.contacts_there.items() if kinds.get(name) not in WITHOUT_PRESSURE}


def carried(tables):
    """The tables of contacts, by their names, each with the nodes that have its conditions as those of side a."""
    return {name: turned(table) for name, table in tables.items()}


def turned(table):
    """A table, or a copy with its sides swapped where the nodes of side b have the conditions."""
    on_b = (table["node_a"] == -1) & (table["node_b"] != -1)
    if not on_b.any():
        return table
    table = table.copy()
    table["node_a"][on_b], table["node_b"][on_b] = table["node_b"][on_b], -1
    for column in ("normal", "tangential_force", "slip"):
        if column in table.dtype.names:
            table[column][on_b] *= -1
    return table
