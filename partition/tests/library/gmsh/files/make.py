"""Writes the MSH files of this directory with Gmsh's own writer: python3 make.py

Two unit squares in the plane z = 1.5, the upper one turned over, with a group that both are in, a
group without a name, a curve in two groups, and a point that nothing uses.
"""

import gmsh

gmsh.initialize()
geo = gmsh.model.geo


def rectangle(y, sign):
    corners = [(0, y), (1, y), (1, y + 1), (0, y + 1)]
    points = [geo.addPoint(*c, 1.5, 0.5) for c in corners]
    lines = [geo.addLine(points[i], points[(i + 1) % 4]) for i in range(4)]
    loop = geo.addCurveLoop([sign * line for line in lines[::sign]])
    return points, lines, geo.addPlaneSurface([loop])


points, lower, body = rectangle(0, 1)
_, upper, other = rectangle(1, -1)
geo.addPoint(5, 5, 9)
geo.synchronize()
group = gmsh.model.addPhysicalGroup
group(2, [body], 1, "lower body")
group(2, [other], 2, "upper body")
group(2, [body, other], 5, "both")
group(1, [lower[2]], 4, "lower face")
group(1, [-upper[0]], 6, "upper face")
group(1, [lower[0], upper[2]], 8, "ends")
group(1, [lower[0]], 11)
group(0, [points[0]], 2, "corner")
gmsh.model.mesh.generate(2)
for version in (2.2, 4.1):
    for binary in (0, 1):
        for parametric in (0, 1):
            gmsh.option.setNumber("Mesh.MshFileVersion", version)
            gmsh.option.setNumber("Mesh.Binary", binary)
            gmsh.option.setNumber("Mesh.SaveParametric", parametric)
            encoding = "binary" if binary else "ascii"
            kind = "-parametric" if parametric else ""
            gmsh.write(f"version{version:g}-{encoding}{kind}.msh")
gmsh.finalize()
