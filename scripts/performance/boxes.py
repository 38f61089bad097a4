"""Two boxes of tetrahedra, one on the other, as a mesh of any size: a contact that opens in part, or one body.

    python3 boxes.py CELLS FOLDER       writes FOLDER/boxes-CELLS.msh and .toml, and the same with -tied in the names

CELLS are along the edges of the base, half as many in the height of a box. The lower one is held at its bottom; the top of
the upper one is moved down on one side and up on the other. Tied, both are one body under a pressure on its top: a linear
problem on nearly the same mesh.
"""

import pathlib
import sys

import numpy as np

YOUNG, POISSON = 210e9, 0.3
PRESSURE = 1e6
PUSH = 1e-4
# Six tetrahedra of a cube around its diagonal; corner c is at (c, c >> 1, c >> 2) & 1.
CORNERS = [[0, 1, 3, 7], [0, 1, 7, 5], [0, 5, 7, 4], [0, 3, 2, 7], [0, 2, 6, 7], [0, 6, 4, 7]]

SCENE = """\
title = "Two boxes"
mesh = "{mesh}"
materials.steel = {{ young = {young:e}, poisson = {poisson} }}
bodies.lower.material = "steel"
{more}
[[displacement]]
on = "bottom"
x = 0
y = 0
z = 0
"""
CONTACT = """
[[displacement]]
on = "top"
x = 0
y = 0
z = "-{push}*(1-1.6*x)"
[[contact]]
name = "joint"
sides = ["upper bottom", "lower top"]
"""
TIED = """
[[pressure]]
on = "top"
value = "{pressure}*(1-1.6*x)"
"""


def box(cells, first, height):
    """Points, tetrahedra, and triangles of bottom and top, of a box whose nodes are counted from `first`."""
    nodes = np.array(cells) + 1
    grid = np.stack(np.meshgrid(*(np.arange(n) for n in nodes), indexing="ij"), axis=-1)
    points = grid.reshape(-1, 3) / cells[0] + np.array([0, 0, height])
    number = np.arange(np.prod(nodes)).reshape(nodes) + first

    def corner(c):
        x, y, z = (slice(c >> k & 1, nodes[k] - 1 + (c >> k & 1)) for k in range(3))
        return number[x, y, z].ravel()

    cubes = np.stack([corner(c) for c in range(8)], axis=1)

    def side(k):
        at = number[:, :, k]
        a, b, c, d = (part.ravel() for part in (at[:-1, :-1], at[1:, :-1], at[1:, 1:], at[:-1, 1:]))
        return np.concatenate([np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1)])

    return points, np.concatenate([cubes[:, corners] for corners in CORNERS]), side(0), side(-1)


def groups(cells, tied, first=1):
    """Points, and dimension, name and cells of every physical group."""
    half = cells // 2
    if tied:
        points, solid, bottom, top = box([cells, cells, 2 * half], first, 0)
        return points, [(3, "lower", solid), (2, "bottom", bottom), (2, "top", top)]
    points, lower, bottom, below = box([cells, cells, half], first, 0)
    others, upper, above, top = box([cells, cells, half], first + len(points), half / cells)
    return np.concatenate([points, others]), [
        (3, "lower", lower), (3, "upper", upper), (2, "bottom", bottom), (2, "lower top", below),
        (2, "upper bottom", above), (2, "top", top),
    ]


def write(cells, folder):
    folder = pathlib.Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    for tied in (False, True):
        path = folder / f"boxes-{cells}{'-tied' * tied}.msh"
        points, parts = groups(cells, tied)
        with path.open("w") as file:
            file.write(f"$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n{len(parts)}\n")
            for number, (dim, name, _) in enumerate(parts, 1):
                file.write(f'{dim} {number} "{name}"\n')
            file.write(f"$EndPhysicalNames\n$Nodes\n{len(points)}\n")
            rows = np.column_stack([np.arange(1, len(points) + 1), points])
            np.savetxt(file, rows, fmt="%d %.17g %.17g %.17g")
            file.write(f"$EndNodes\n$Elements\n{sum(len(nodes) for *_, nodes in parts)}\n")
            at = 1
            for number, (dim, _, nodes) in enumerate(parts, 1):
                head = np.tile([4 if dim == 3 else 2, 2, number, number], (len(nodes), 1))
                np.savetxt(file, np.column_stack([np.arange(at, at + len(nodes)), head, nodes]), fmt="%d")
                at += len(nodes)
            file.write("$EndElements\n")
        more = "" if tied else 'bodies.upper.material = "steel"'
        scene = SCENE.format(mesh=path.name, young=YOUNG, poisson=POISSON, more=more)
        scene += TIED.format(pressure=PRESSURE) if tied else CONTACT.format(push=PUSH)
        path.with_suffix(".toml").write_text(scene)


if __name__ == "__main__":
    write(int(sys.argv[1]), sys.argv[2])
