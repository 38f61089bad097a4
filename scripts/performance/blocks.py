"""Meshes of mapped rectangles in Gmsh's format MSH 2.2, of quadrilaterals with four or eight nodes."""

LINES = {"quad4": 1, "quad8": 8}
CELLS = {"quad4": 3, "quad8": 16}


class Blocks:
    """A mesh under construction: blocks share no nodes unless they say so."""

    def __init__(self, kind, fine=1):
        self.kind, self.fine = kind, fine
        self.points, self.names, self.elements, self.keys = [], {}, [], {}

    @property
    def is_quadratic(self):
        return self.kind == "quad8"

    def group(self, dim, name):
        return self.names.setdefault((dim, name), len(self.names) + 1)

    def rectangle(self, name, x, y, n, key=None):
        """[x0, x1] × [y0, y1] in n[0] × n[1] cells, each cut `fine` times along both sides."""
        return self.mapped(name, n, lambda s, t: (x[0] + (x[1] - x[0]) * s, y[0] + (y[1] - y[0]) * t), key)

    def mapped(self, name, n, to, key=None):
        """The image of the unit square: cells `name`, sides `name bottom`, `right`, `top`, `left`. Nodes whose `key` of
        the position is the same, and not None, are one."""
        steps = 2 if self.is_quadratic else 1
        n, nodes = [self.fine * k for k in n], {}

        def node(i, j):
            if (i, j) not in nodes:
                nodes[i, j] = self.node(to(i / (steps * n[0]), j / (steps * n[1])), key)
            return nodes[i, j]

        corners = [(0, 0), (1, 0), (1, 1), (0, 1)]
        local = [(steps * i, steps * j) for i, j in corners]
        if self.is_quadratic:
            local += [(1, 0), (2, 1), (1, 2), (0, 1)]
        cells = self.group(2, name)
        for j in range(n[1]):
            for i in range(n[0]):
                of_cell = [node(steps * i + a, steps * j + b) for a, b in local]
                self.elements.append((CELLS[self.kind], cells, of_cell))
        right, top = steps * n[0], steps * n[1]
        self.line(f"{name} bottom", [node(i, 0) for i in range(right + 1)])
        self.line(f"{name} right", [node(right, j) for j in range(top + 1)])
        self.line(f"{name} top", [node(right - i, top) for i in range(right + 1)])
        self.line(f"{name} left", [node(0, top - j) for j in range(top + 1)])
        return self

    def node(self, at, key):
        known = key(*at) if key else None
        if known is not None and known in self.keys:
            return self.keys[known]
        self.points.append(at)
        if known is not None:
            self.keys[known] = len(self.points)
        return len(self.points)

    def line(self, name, nodes):
        steps, group = (2 if self.is_quadratic else 1), self.group(1, name)
        for k in range(0, len(nodes) - 1, steps):
            ends = [nodes[k], nodes[k + steps]] + ([nodes[k + 1]] if self.is_quadratic else [])
            self.elements.append((LINES[self.kind], group, ends))

    def renamed(self, names):
        """The mesh with groups renamed, which may merge them; sides without a new name are left out."""
        number = {}
        for (dim, name), group in list(self.names.items()):
            if name in names or dim == 2:
                number[group] = (dim, names.get(name, name))
        self.names = {}
        kept = [(kind, number[group], nodes) for kind, group, nodes in self.elements if group in number]
        self.elements = [(kind, self.group(*of), nodes) for kind, of, nodes in kept]
        return self

    def write(self, path):
        lines = ["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$PhysicalNames", str(len(self.names))]
        lines += [f'{dim} {group} "{name}"' for (dim, name), group in self.names.items()]
        lines += ["$EndPhysicalNames", "$Nodes", str(len(self.points))]
        lines += [f"{k} {x!r} {y!r} 0" for k, (x, y) in enumerate(self.points, 1)]
        lines += ["$EndNodes", "$Elements", str(len(self.elements))]
        for k, (kind, group, nodes) in enumerate(self.elements, 1):
            lines.append(f"{k} {kind} 2 {group} {group} " + " ".join(map(str, nodes)))
        path.write_text("\n".join([*lines, "$EndElements", ""]))
