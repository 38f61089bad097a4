"""Writes the MSH files of this directory in space with Gmsh's own writer: python3 make3d.py

A quarter of a hollow cylinder, 1 < r < 2 and 0 < z < 1: tetrahedra, linear and quadratic, and hexahedra
of 8, 20 and 27 nodes.
"""

from math import pi

import gmsh

for shape, orders in (
    ("tetrahedra", ((1, 0, "4"), (2, 0, "10"))),
    ("hexahedra", ((1, 0, "8"), (2, 1, "20"), (2, 0, "27"))),
):
    gmsh.initialize()
    gmsh.option.setNumber("General.Terminal", 0)
    geo = gmsh.model.geo
    line = geo.addLine(geo.addPoint(1, 0, 0), geo.addPoint(2, 0, 0))
    geo.mesh.setTransfiniteCurve(line, 3)
    recombine = shape == "hexahedra"
    _, strip, *_ = geo.extrude([(1, line)], 0, 0, 1, [2], recombine=recombine)
    extruded = geo.revolve([strip], 0, 0, 0, 0, 0, 1, pi / 2, [3], recombine=recombine)
    geo.synchronize()
    sides = {"inner": [], "outer": []}
    for _, tag in gmsh.model.getEntities(2):
        x, y, z, *high = gmsh.model.getBoundingBox(2, tag)
        corners = [round(c, 4) for c in (x, y, z, *high)]
        for radius, name in enumerate(sides, 1):
            if corners == [0, 0, 0, radius, radius, 1]:
                sides[name].append(tag)
    gmsh.model.addPhysicalGroup(3, [extruded[1][1]], 1, "ring")
    for number, name in enumerate(sides, 2):
        gmsh.model.addPhysicalGroup(2, sides[name], number, name)
    gmsh.model.mesh.generate(3)
    for order, incomplete, name in orders:
        gmsh.option.setNumber("Mesh.SecondOrderIncomplete", incomplete)
        gmsh.model.mesh.setOrder(1)
        gmsh.model.mesh.setOrder(order)
        for version in (2.2, 4.1):
            for binary in (0, 1):
                gmsh.option.setNumber("Mesh.MshFileVersion", version)
                gmsh.option.setNumber("Mesh.Binary", binary)
                form = "binary" if binary else "ascii"
                gmsh.write(f"{shape}-{name}-{version:g}-{form}.msh")
    gmsh.finalize()
