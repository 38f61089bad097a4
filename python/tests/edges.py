"""Scenes with edges, corners, curved contact and friction, meshed by Gmsh with cells of a size: what error bars are
checked against. Gmsh's model stays, for `adapt`, until it is finalized."""

import gmsh

from contact_dd import Material, Model

STEEL, ALUMINIUM = Material(young=210e3, poisson=0.3), Material(young=70e3, poisson=0.33)


def start(size):
    gmsh.initialize(interruptible=False)
    gmsh.option.setNumber("General.Terminal", 0)
    gmsh.model.add("scene")
    gmsh.option.setNumber("Mesh.MeshSizeMax", size)


def polygon(points, arcs=()):
    """A surface, and the curves around it, of which some are arcs around centres."""
    arcs = dict(arcs)
    corners = [gmsh.model.geo.addPoint(*at, 0) for at in points]
    curves = []
    for k, (a, b) in enumerate(zip(corners, corners[1:] + corners[:1])):
        if k in arcs:
            curves.append(gmsh.model.geo.addCircleArc(a, gmsh.model.geo.addPoint(*arcs[k], 0), b))
        else:
            curves.append(gmsh.model.geo.addLine(a, b))
    return gmsh.model.geo.addPlaneSurface([gmsh.model.geo.addCurveLoop(curves)]), curves


def model_of(kind, plane, bodies, sides):
    """A model of triangles or quadrilaterals of first or second order: `kind` is ("tri", 1) and the like. `bodies` have
    surfaces and materials, `sides` curves."""
    gmsh.model.geo.synchronize()
    for name, (surface, _) in bodies.items():
        gmsh.model.addPhysicalGroup(2, [surface], name=name)
    for name, curves in sides.items():
        gmsh.model.addPhysicalGroup(1, curves, name=name)
    cells, order = kind
    if cells == "quad":
        gmsh.option.setNumber("Mesh.RecombineAll", 1)
        gmsh.option.setNumber("Mesh.Algorithm", 8)
    gmsh.model.mesh.generate(2)
    if order == 2:
        gmsh.option.setNumber("Mesh.SecondOrderIncomplete", 1)
        gmsh.model.mesh.setOrder(2)
    model = Model.from_mesh(gmsh.model, plane, units="mm")
    for name, (_, material) in bodies.items():
        model.body(name, material)
    return model


def rounded_punch(size, kind):
    """A punch around an axis, its edge rounded, pushed into a block by a displacement."""
    start(size)
    punch, p = polygon([(0, 0), (4.5, 0), (5, 0.5), (5, 8), (0, 8)], {1: (4.5, 0.5)})
    block, b = polygon([(0, -12), (15, -12), (15, 0), (0, 0)])
    bodies = {"punch": (punch, STEEL), "block": (block, ALUMINIUM)}
    sides = {"top": [p[3]], "axis": [p[4], b[3]], "face": p[:2], "ground": [b[0]], "upper": [b[2]]}
    model = model_of(kind, "axisymmetric", bodies, sides)
    model.fix("axis", x=0)
    model.fix("ground")
    model.fix("top", y=-0.2)
    model.contact("face", "upper", friction=0.1)
    return model


def sharp_punch(size, kind):
    """A punch with sharp edges, loaded aslant."""
    start(size)
    punch, p = polygon([(-2, 0), (2, 0), (2, 3), (-2, 3)])
    block, b = polygon([(-6, -6), (6, -6), (6, 0), (-6, 0)])
    bodies = {"punch": (punch, STEEL), "block": (block, ALUMINIUM)}
    sides = {"top": [p[2]], "face": [p[0]], "ground": [b[0]], "upper": [b[2]]}
    model = model_of(kind, "strain", bodies, sides)
    model.fix("ground")
    model.load("top", traction=[30, -300])
    model.contact("face", "upper", friction=0.3)
    return model


def t_slot(size, kind):
    """Half of a T, pulled in its slot."""
    start(size)
    tee, t = polygon([(0, 0), (6, 0), (6, 2), (3, 2), (3, 12), (0, 12)])
    block, b = polygon([(3.2, 2), (10, 2), (10, 10), (3.2, 10)])
    bodies = {"tee": (tee, STEEL), "block": (block, STEEL)}
    sides = {"pulled": [t[4]], "axis": [t[5]], "shoulder": [t[2]], "lip": [b[0]], "held": [b[1]]}
    model = model_of(kind, "strain", bodies, sides)
    model.fix("axis", x=0)
    model.fix("held")
    model.load("pulled", traction=[0, 100])
    model.contact("shoulder", "lip", friction=0.2)
    return model


def bracket(size, kind):
    """An angle with a sharp inner corner, that lifts from its ground."""
    start(size)
    body, c = polygon([(0, 0), (20, 0), (20, 4), (4, 4), (4, 20), (0, 20)])
    model = model_of(kind, "stress", {"bracket": (body, STEEL)}, {"foot": [c[0]], "back": [c[5]], "end": [c[4]]})
    model.fix("back", x=0)
    model.load("end", traction=[4, -30])
    model.obstacle("foot", point=[0, 0], normal=[0, 1], friction=0.4)
    return model


def pin_in_hole(size, kind):
    """Half of a pin with clearance in a plate, pressed down by its weight."""
    start(size)
    corners = [(0, -15), (15, -15), (15, 15), (0, 15), (0, 5), (5, 0), (0, -5)]
    plate, p = polygon(corners, {4: (0, 0), 5: (0, 0)})
    pin, q = polygon([(0, -5), (4.95, -0.05), (0, 4.9)], {0: (0, -0.05), 1: (0, -0.05)})
    bodies = {"plate": (plate, ALUMINIUM), "pin": (pin, STEEL)}
    sides = {"axis": [p[3], p[6], q[2]], "bottom": [p[0]], "hole": [p[5]], "lower": [q[0]]}
    model = model_of(kind, "strain", bodies, sides)
    model.load("pin", body_force=[0, -20])
    model.fix("axis", x=0)
    model.fix("bottom")
    model.contact("lower", "hole", friction=0.2)
    return model


def rings(size, kind):
    """Quarters of two rings, the inner one too large."""
    start(size / 10)
    core, c = polygon([(1, 0), (2, 0), (0, 2), (0, 1)], {1: (0, 0), 3: (0, 0)})
    ring, r = polygon([(2, 0), (3, 0), (0, 3), (0, 2)], {1: (0, 0), 3: (0, 0)})
    bodies = {"core": (core, STEEL), "ring": (ring, STEEL)}
    sides = {"flat": [c[0], r[0]], "upright": [c[2], r[2]], "outer": [c[1]], "inner": [r[3]]}
    model = model_of(kind, "strain", bodies, sides)
    model.fix("flat", y=0)
    model.fix("upright", x=0)
    model.contact("outer", "inner", gap=-1e-3, interference=True)
    return model


def cylinder(size, kind):
    """Half of a cylinder, pressed on a block and then pushed aside."""
    start(size)
    body, c = polygon([(-10, 10), (0, 0), (10, 10)], {0: (0, 10), 1: (0, 10)})
    block, b = polygon([(-12, -12), (12, -12), (12, 0), (-12, 0)])
    bodies = {"cylinder": (body, STEEL), "block": (block, ALUMINIUM)}
    sides = {"top": [c[2]], "face": c[:2], "ground": [b[0]], "upper": [b[2]]}
    model = model_of(kind, "strain", bodies, sides)
    held = {"on": "ground", "x": 0, "y": 0}
    model.fix("ground")
    model.fix("top", x=0, y=-0.1)
    model.contact("face", "upper", friction=0.3)
    model.steps({"name": "down"}, {"name": "aside", "displacement": [held, {"on": "top", "x": 0.02, "y": -0.1}]})
    return model


def beam(size, kind):
    """A beam on a ground that its ends leave."""
    start(size)
    upper, u = polygon([(-10, 0), (10, 0), (10, 2), (1, 2), (-1, 2), (-10, 2)])
    lower, g = polygon([(-14, -8), (14, -8), (14, 0), (-14, 0)])
    bodies = {"beam": (upper, STEEL), "ground": (lower, ALUMINIUM)}
    sides = {"pressed": [u[3]], "face": [u[0]], "base": [g[0]], "upper": [g[2]]}
    model = model_of(kind, "strain", bodies, sides)
    model.fix("base")
    model.load("pressed", traction=[10, -100])
    model.contact("face", "upper", friction=0.5)
    return model


def dovetail(size, kind):
    """The root of a blade, pulled against an inclined flank that it overhangs."""
    start(size)
    blade, b = polygon([(0, 0), (8, 0), (4, 4), (4, 12), (0, 12)])
    disc, d = polygon([(8.5, -0.5), (14, -0.5), (14, 9), (4.2, 9), (4.2, 3.8)])
    bodies = {"blade": (blade, STEEL), "disc": (disc, STEEL)}
    sides = {"pulled": [b[3]], "axis": [b[4]], "flank": [b[1]], "seat": [d[4]], "held": [d[1]]}
    model = model_of(kind, "strain", bodies, sides)
    model.fix("axis", x=0)
    model.fix("held")
    model.load("pulled", traction=[0, 150])
    model.contact("flank", "seat", friction=0.3)
    return model


# With the size of the coarsest cells.
SCENES = {
    rounded_punch: 2.0, sharp_punch: 1.0, t_slot: 1.5, bracket: 2.0, pin_in_hole: 2.0, rings: 4.0, cylinder: 2.0,
    beam: 1.0, dovetail: 1.5,
}


def on_meshes(scene, kind, sizes, folder=None):
    """Results of a scene on uniform meshes."""
    results = []
    for size in sizes:
        try:
            results.append(scene(size, kind).run(ranks=1, folder=folder and folder / str(size), progress=False))
        finally:
            gmsh.finalize()
    return results


def outside(compared, truth):
    """The numbers outside of their bars, by how many bars they are off, and how many have a bar."""
    barred = [one for one in compared if one.error is not None and one.name in truth]
    off = {one.name: abs(one.values[-1] - truth[one.name]) / one.error for one in barred}
    return {name: bars for name, bars in off.items() if bars > 1}, len(barred)
