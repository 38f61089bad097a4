"""Writes the MSH files of this directory with Gmsh's own writer: python3 make.py

A quarter of a ring, 1 < r < 2, the half at the x axis in quadrilaterals, the half at the y axis in
triangles: linear, quadratic with nine nodes a quadrilateral, and with eight.
"""

from math import cos, pi, sin

import gmsh

gmsh.initialize()
gmsh.option.setNumber("General.Terminal", 0)
geo = gmsh.model.geo
centre = geo.addPoint(0, 0, 0)
angles = [0, pi / 4, pi / 2]
rings = [[geo.addPoint(r * cos(a), r * sin(a), 0) for a in angles] for r in (1, 2)]
arcs = [[geo.addCircleArc(p[k], centre, p[k + 1]) for k in (0, 1)] for p in rings]
rays = [geo.addLine(rings[0][k], rings[1][k]) for k in range(3)]
sectors = []
for k in (0, 1):
    loop = geo.addCurveLoop([rays[k], arcs[1][k], -rays[k + 1], -arcs[0][k]])
    sectors.append(geo.addPlaneSurface([loop]))
for curve in arcs[0] + arcs[1]:
    geo.mesh.setTransfiniteCurve(curve, 4)
for curve in rays:
    geo.mesh.setTransfiniteCurve(curve, 3)
for sector in sectors:
    geo.mesh.setTransfiniteSurface(sector)
geo.mesh.setRecombine(2, sectors[0])
geo.synchronize()
gmsh.model.addPhysicalGroup(2, sectors, 1, "ring")
gmsh.model.addPhysicalGroup(1, arcs[0], 2, "inner")
gmsh.model.addPhysicalGroup(1, arcs[1], 3, "outer")
gmsh.model.mesh.generate(2)
for order, incomplete, name in ((1, 0, "linear"), (2, 0, "nine"), (2, 1, "eight")):
    gmsh.option.setNumber("Mesh.SecondOrderIncomplete", incomplete)
    gmsh.model.mesh.setOrder(1)
    gmsh.model.mesh.setOrder(order)
    for version in (2.2, 4.1):
        for binary in (0, 1):
            gmsh.option.setNumber("Mesh.MshFileVersion", version)
            gmsh.option.setNumber("Mesh.Binary", binary)
            gmsh.write(f"{name}-{version:g}-{'binary' if binary else 'ascii'}.msh")
gmsh.finalize()
