"""The granite block with two edge cracks as an unstructured Gmsh mesh of any size.

    python granite.py DOFS FOLDER      writes FOLDER/granite-DOFS.msh and .toml

The geometry, the supports and the loads are those of `contact-dd-partition --example granite`; the
triangles are Gmsh's, all of one size, and the nodes of the two sides of a crack match.
"""

import math
import pathlib
import sys

SCENE = """\
title = "Loaded granite block with cracks"
mesh = "{mesh}"
plane = "strain"

[materials.granite]
young = 5.2e9
poisson = 0.18

[bodies.block]
material = "granite"

[[displacement]]
on = "bottom"
x = 0.0
y = 0.0

[[pressure]]
on = "lower right"
value = 0.6e7
[[pressure]]
on = "top"
value = 0.3e7
[[pressure]]
on = "upper left"
value = 0.6e7

[[contact]]
name = "left crack"
sides = ["left crack lower", "left crack upper"]
gap = 0.0
[[contact]]
name = "right crack"
sides = ["right crack lower", "right crack upper"]
gap = 0.0
"""

SIDE = 10.0


def mesh_size(dofs):
    """Edge length of equilateral triangles that fill the block with `dofs` dofs; its boundary and
    the cracks' second sides bring half a node per edge of theirs on top."""
    boundary = 4 * SIDE + 2 * 2 * math.hypot(3, 1.5)
    nodes, h = dofs / 2, math.sqrt(2 * SIDE**2 / (math.sqrt(3) * dofs / 2))
    for _ in range(20):
        h = math.sqrt(2 * SIDE**2 / (math.sqrt(3) * (nodes - boundary / h / 2)))
    return h


def write(dofs, folder):
    import gmsh

    folder = pathlib.Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    mesh, h = folder / f"granite-{dofs}.msh", mesh_size(dofs)
    gmsh.initialize()
    gmsh.option.setNumber("General.Verbosity", 2)
    model, geometry = gmsh.model, gmsh.model.geo

    def point(x, y):
        return geometry.addPoint(x, y, 0, h)

    # The numbers are those of the paper's figure; 5 and 8, the mouths, are there for either side.
    p1, p2, p3, p4 = point(0, 0), point(SIDE, 0), point(0, SIDE), point(SIDE, SIDE)
    p6, p7 = point(3, 5), point(7, 5)
    p5_lower, p5_upper = point(0, 6.5), point(0, 6.5)
    p8_lower, p8_upper = point(SIDE, 6.5), point(SIDE, 6.5)
    line = geometry.addLine
    ligament = line(p7, p6)
    lower = {
        "bottom": line(p1, p2),
        "lower right": line(p2, p8_lower),
        "right crack lower": line(p8_lower, p7),
        None: ligament,
        "left crack lower": line(p6, p5_lower),
        "lower left": line(p5_lower, p1),
    }
    upper = {
        "left crack upper": line(p5_upper, p6),
        None: -ligament,
        "right crack upper": line(p7, p8_upper),
        "upper right": line(p8_upper, p4),
        "top": line(p4, p3),
        "upper left": line(p3, p5_upper),
    }
    halves = [
        geometry.addPlaneSurface([geometry.addCurveLoop(list(half.values()))])
        for half in (lower, upper)
    ]
    geometry.synchronize()
    nodes = max(2, round(math.hypot(3, 1.5) / h)) + 1
    for half in (lower, upper):
        for name, curve in half.items():
            if name and "crack" in name:
                model.mesh.setTransfiniteCurve(curve, nodes)
            if name:
                model.addPhysicalGroup(1, [curve], name=name)
    model.addPhysicalGroup(2, halves, name="block")
    model.mesh.generate(2)
    gmsh.option.setNumber("Mesh.Binary", 1)
    gmsh.write(str(mesh))
    gmsh.finalize()
    mesh.with_suffix(".toml").write_text(SCENE.format(mesh=mesh.name))


if __name__ == "__main__":
    write(int(sys.argv[1]), sys.argv[2])
