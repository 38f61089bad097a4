"""Contacts as the side sees them whose nodes have the conditions."""


def carried(tables):
    """The tables of contacts, by their names, each with the nodes that have its conditions as those of side a."""
    return {name: turned(table) for name, table in tables.items()}


def turned(table):
    """A table, or a copy with its sides exchanged where it is side b whose nodes have the conditions."""
    on_b = (table["node_a"] == -1) & (table["node_b"] != -1)
    if not on_b.any():
        return table
    table = table.copy()
    table["node_a"][on_b], table["node_b"][on_b] = table["node_b"][on_b], -1
    for column in ("normal", "tangential_force", "slip"):
        if column in table.dtype.names:
            table[column][on_b] *= -1
    return table
