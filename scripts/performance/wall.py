"""A wall of bricks in running bond, every joint of which is a contact, as a Gmsh mesh of any size.

    python wall.py BRICKS COURSES CELLS FOLDER      writes FOLDER/wall-BRICKS-COURSES-CELLS.msh and .toml,
                                                    and the same with -tied in the names

BRICKS stand in the length of every course, in every other one two halves for one of them; CELLS are in
the height of a brick. The wall is that of `contact-dd-partition --example wall`, between two pillars on
ground that sank under its middle. Tied, all bricks are one body, and the ground holds them in either
direction: a linear problem on the same mesh.
"""

import pathlib
import sys

LENGTH, HEIGHT = 0.25, 0.125

SCENE = """\
title = "Wall of bricks"
mesh = "{mesh}"
plane = "strain"
materials.clay = {{ young = 8e9, poisson = 0.2 }}
bodies.bricks = {{ material = "clay", body_force = [0.0, -18e3] }}

[[bilateral]]
on = ["left end", "right end"]
[[pressure]]
on = "top"
value = 50e3
"""
TIED = """
[[bilateral]]
on = "foot"
"""
GROUND = """
[[contact]]
name = "ground"
sides = ["foot"]
obstacle = {{ point = [0.0, 0.0], normal = [0.0, 1.0] }}
gap = "4e-4*exp(-((x - {middle})/{width})^2)"
"""
JOINT = """
[[contact]]
name = "{joint}"
sides = ["{first}", "{second}"]
gap = 0.0
"""


def name(bricks, courses, cells, tied=False):
    return f"wall-{bricks}-{courses}-{cells}{'-tied' * tied}"


def write(bricks, courses, cells, folder):
    import gmsh

    folder = pathlib.Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    gmsh.initialize()
    gmsh.option.setNumber("General.Verbosity", 2)
    gmsh.option.setNumber("Mesh.Binary", 1)
    geometry, mesh = gmsh.model.geo, gmsh.model.mesh
    sides, surfaces = {}, []
    for course in range(courses):
        # Ends of bricks in halves of a brick.
        ends = [0, *range(2 - course % 2, 2 * bricks, 2), 2 * bricks]
        below, above = f"bed joint {course}, upper side", f"bed joint {course + 1}, lower side"
        left, right = f"head joints {course + 1}, right side", f"head joints {course + 1}, left side"
        for start, end in zip(ends, ends[1:]):
            corners = [
                geometry.addPoint(LENGTH * at / 2, HEIGHT * row, 0)
                for at, row in [(start, course), (end, course), (end, course + 1), (start, course + 1)]
            ]
            lines = [geometry.addLine(corners[i], corners[(i + 1) % 4]) for i in range(4)]
            for line, count in zip(lines, [(end - start) * cells, cells] * 2):
                geometry.mesh.setTransfiniteCurve(line, count + 1)
            surfaces.append(geometry.addPlaneSurface([geometry.addCurveLoop(lines)]))
            geometry.mesh.setTransfiniteSurface(surfaces[-1], "Left", corners)
            names = [
                below if course > 0 else "foot",
                right if end < 2 * bricks else "right end",
                above if course + 1 < courses else "top",
                left if start > 0 else "left end",
            ]
            for line, side in zip(lines, names):
                sides.setdefault(side, []).append(line)
    geometry.synchronize()
    for side, lines in sides.items():
        gmsh.model.addPhysicalGroup(1, lines, name=side)
    gmsh.model.addPhysicalGroup(2, surfaces, name="bricks")
    mesh.generate(2)
    length = LENGTH * bricks
    contacts = GROUND.format(middle=length / 2, width=length / 5)
    for joint in sorted({side.split(",")[0] for side in sides if "joint" in side}):
        first, second = (side for side in sides if side.startswith(f"{joint},"))
        contacts += JOINT.format(joint=joint, first=first, second=second)
    for tied in (False, True):
        path = folder / f"{name(bricks, courses, cells, tied)}.msh"
        if tied:
            mesh.removeDuplicateNodes()
        gmsh.write(str(path))
        path.with_suffix(".toml").write_text(SCENE.format(mesh=path.name) + (TIED if tied else contacts))
    gmsh.finalize()


if __name__ == "__main__":
    write(*map(int, sys.argv[1:4]), sys.argv[4])
