"""Scenes with quantities of every kind, on meshes of any fineness of the same geometry."""

import math

from blocks import Blocks

MATERIALS = "materials.rock = {young = 2e10, poisson = 0.25}\nmaterials.steel = {young = 8e10, poisson = 0.3}\n"

FLOOR = {"point": [0, 0], "normal": [0, 1]}


def head(plane="strain", **bodies):
    return f"plane = '{plane}'\n" + MATERIALS + "".join(f"bodies.{b}.material = '{m}'\n" for b, m in bodies.items())


def toml(value):
    if isinstance(value, dict):
        return "{" + ", ".join(f"{key} = {toml(one)}" for key, one in value.items()) + "}"
    return "true" if value is True else repr(value)


def table(of, /, **keys):
    return f"[[{of}]]\n" + "".join(f"{key} = {toml(value)}\n" for key, value in keys.items())


def quantity(name, kind, **keys):
    return table("quantity", name=name, kind=kind, **keys)


def fixed(*on):
    return "".join(table("displacement", on=one, x=0, y=0) for one in on)


def contact(name, sides, law="", **keys):
    return table("contact", name=name, sides=sides, **keys) + law + "\n"


def at_point(name, at, direction):
    return quantity(name, "displacement", at=at, direction=direction)


def corner(x, y):
    return round(x, 7), round(y, 7)


def clamped(kind, fine):
    mesh = Blocks(kind, fine).rectangle("b", [0, 2], [0, 1], [8, 4])
    loads = fixed("b left") + table("traction", on="b right", value=[0, -1e6])
    asked = at_point("corner", [2.0, 1.0], "y") + at_point("middle", [1.0, 1.0], "y") + quantity("energy", "energy")
    return mesh, head(b="rock") + loads + asked


def angle(kind, fine):
    mesh = Blocks(kind, fine)
    mesh.rectangle("b", [0, 1], [0, 1], [4, 4], corner).rectangle("end", [1, 2], [0, 1], [4, 4], corner)
    mesh.rectangle("foot", [0, 1], [1, 2], [4, 4], corner)
    mesh.renamed({"b": "b", "end": "b", "foot": "b", "end right": "end", "foot top": "foot"})
    loads = fixed("foot") + table("traction", on="end", value=[0, 1e6])
    asked = at_point("corner", [2.0, 1.0], "y") + at_point("inner corner", [1.0, 1.0], "y")
    return mesh, head(b="rock") + loads + asked + quantity("energy", "energy")


def foundation(law="", steps=""):
    def made(kind, fine):
        mesh = Blocks(kind, fine).rectangle("block", [0, 2], [0, 1], [8, 4])
        text = head(block="rock") + table("displacement", on="block left", x=0)
        text += table("pressure", on="block top", value="1e7*(1+cos(pi*x/2))")
        text += contact("ground", ["block bottom"], law, obstacle=FLOOR, gap="4e-4*x^2")
        text += quantity("smooth", "largest_pressure", contact="ground", over=0.5)
        text += quantity("opening", "opening", contact="ground", at=[2.0, 0.0]) + at_point("corner", [2.0, 1.0], "y")
        text += quantity("moment", "contact_moment", contact="ground", about=[0.0, 0.0])
        if law:
            text += quantity("side", "reaction", on="block left", direction="x")
        return mesh, text + quantity("energy", "energy") + steps

    return made


def stack(law):
    def made(kind, fine):
        mesh = Blocks(kind, fine).rectangle("a", [0, 2], [0, 1], [8, 4])
        mesh.rectangle("b", [0.25, 1.75], [1, 2], [6, 4]).rectangle("c", [0.25, 1.25], [2, 3], [4, 4])
        text = head(a="rock", b="steel", c="rock") + fixed("a bottom")
        text += table("pressure", on="c top", value="1e6*(1+0.5*x)") + table("traction", on="c right", value=[-2e5, 0])
        text += contact("low", ["b bottom", "a top"], law) + contact("high", ["c bottom", "b top"], law)
        if law:
            text += quantity("mean stress", "mean_stress", body="b", component="xx")
        else:
            text += "".join(table("displacement", on=on, x=0) for on in ("c left", "b left"))
            text += quantity("tilt", "contact_moment", contact="low", about=[0.5, 1.0])
        text += at_point("corner", [1.25, 3.0], "y") + at_point("corner, x", [1.25, 3.0], "x")
        text += quantity("smooth", "largest_pressure", contact="low", over=0.3)
        return mesh, text + quantity("energy", "energy")

    return made


def pillars(law):
    def made(kind, fine):
        mesh, names = Blocks(kind, fine), [f"p{k}" for k in range(3)]
        for name, x in zip(names, (0.0, 1.25, 2.5)):
            mesh.rectangle(name, [x, x + 0.5], [0, 1], [2, 4])
        mesh.rectangle("beam", [0, 3], [1, 1.5], [12, 2])
        text = head(**dict.fromkeys([*names, "beam"], "rock")) + fixed(*(f"{name} bottom" for name in names))
        text += table("pressure", on="beam top", value="1e6*(1+x)")
        text += "".join(contact(f"j{k}", ["beam bottom", f"p{k} top"], law) for k in range(3))
        if law:
            text += table("traction", on="beam right", value=[-4e5, 0])
            text += quantity("shear", "contact_force", contact="j1", direction="x")
        else:
            text += table("displacement", on="beam left", x=0)
        text += quantity("middle", "contact_force", contact="j1") + quantity("mean", "mean_pressure", contact="j2")
        text += quantity("tilt", "contact_moment", contact="j1", about=[1.5, 1.0])
        text += quantity("foot", "reaction", on="p1 bottom", direction="y") + at_point("end", [3.0, 1.5], "y")
        return mesh, text + quantity("energy", "energy")

    return made


def arc(r, facets, s, kind):
    """The point at s in [0, 1] of a quarter of a circle in `facets` straight or parabolic facets."""
    k = min(int(s * facets + 1e-9), facets - 1)
    xi, step = s * facets - k, math.pi / 2 / facets
    start, middle, end = ((r * math.cos(a), r * math.sin(a)) for a in ((k + half / 2) * step for half in range(3)))
    weights = ((1 - xi, 0, xi) if kind == "quad4" else ((1 - xi) * (1 - 2 * xi), 4 * xi * (1 - xi), xi * (2 * xi - 1)))
    return [weights[0] * start[i] + weights[1] * middle[i] + weights[2] * end[i] for i in (0, 1)]


def ring(mesh, name, radii, across):
    def to(s, t):
        inner, outer = (arc(r, 6, t, mesh.kind) for r in radii)
        return tuple(inner[i] + (outer[i] - inner[i]) * s for i in (0, 1))

    return mesh.mapped(name, [across, 6], to)


def lame(kind, fine):
    mesh = ring(Blocks(kind, fine), "ring", (1.0, 2.0), 3)
    loads = table("bilateral", on=["ring bottom", "ring top"]) + table("pressure", on="ring left", value=1e6)
    asked = at_point("bore", [1.0, 0.0], "x") + at_point("outer", [2.0, 0.0], "x") + quantity("energy", "energy")
    return mesh, head(ring="rock") + loads + asked


def shrink(kind, fine):
    mesh = ring(ring(Blocks(kind, fine), "inner", (1.0, 1.5), 3), "outer", (1.5, 2.5), 4)
    text = head(inner="rock", outer="steel")
    text += table("bilateral", on=["inner bottom", "inner top", "outer bottom", "outer top"])
    text += contact("fit", ["inner right", "outer left"], gap=-1e-4, interference=True)
    text += quantity("pressed", "contact_force", contact="fit") + at_point("bore", [1.0, 0.0], "x")
    text += quantity("smooth", "largest_pressure", contact="fit", over=0.3)
    return mesh, text + quantity("energy", "energy")


def crack(load, law=""):
    def made(kind, fine):
        def key(side):
            return lambda x, y: (*corner(x, y), side if abs(y) < 1e-9 and x < 1 - 1e-9 else "")

        mesh = Blocks(kind, fine)
        for name, x, y in (("ll", 0, -1), ("lr", 1, -1), ("ul", 0, 0), ("ur", 1, 0)):
            mesh.rectangle(name, [x, x + 1], [y, y + 1], [6, 6], key(name[0]))
        mesh.renamed({
            "ll": "plate", "lr": "plate", "ul": "plate", "ur": "plate", "ll top": "crack", "ul bottom": "crack up",
            "ll bottom": "bottom", "lr bottom": "bottom", "ul top": "top", "ur top": "top",
        })
        text = head(plate="rock") + fixed("bottom") + load + contact("crack", ["crack", "crack up"], law)
        text += quantity("pressed", "contact_force", contact="crack")
        text += quantity("mean", "mean_pressure", contact="crack") + at_point("corner", [0.0, 1.0], "x")
        text += quantity("mouth", "opening", contact="crack", at=[0.0, 0.0])
        return mesh, text + quantity("energy", "energy")

    return made


def stop(kind, fine):
    mesh = Blocks(kind, fine).rectangle("beam", [0, 4], [0, 0.5], [16, 2])
    text = head(beam="rock") + fixed("beam left") + table("pressure", on="beam top", value=1e6)
    text += contact("stop", ["beam bottom"], obstacle=FLOOR, gap="5e-4 + 1e-2*(x-3)^2")
    text += quantity("force", "contact_force", contact="stop") + at_point("tip", [4.0, 0.0], "y")
    return mesh, text + quantity("reaction", "reaction", on="beam left", direction="y") + quantity("energy", "energy")


def mortar(law):
    def made(kind, fine):
        mesh = Blocks(kind, fine).rectangle("a", [0, 2], [0, 1], [8, 4]).rectangle("b", [0.3, 1.7], [1, 2], [7, 4])
        text = head(a="rock", b="steel") + fixed("a bottom") + table("displacement", on="b top", x=0, y=-1e-4)
        text += contact("j", ["b bottom", "a top"], law) + quantity("force", "contact_force", contact="j")
        text += at_point("corner", [2.0, 1.0], "y") + quantity("smooth", "largest_pressure", contact="j", over=0.3)
        text += quantity("mean stress", "mean_stress", body="a", component="yy")
        return mesh, text + quantity("energy", "energy")

    return made


def punch(kind, fine):
    mesh = Blocks(kind, fine).rectangle("a", [0, 2], [0, 2], [8, 8]).rectangle("p", [0, 0.75], [2, 3], [3, 4])
    text = head("axisymmetric", a="rock", p="steel") + table("displacement", on="a bottom", y=0)
    text += table("displacement", on=["a left", "p left"], x=0) + table("displacement", on="p top", y=-1e-4)
    text += contact("j", ["p bottom", "a top"], pairing="mortar") + quantity("force", "contact_force", contact="j")
    return mesh, text + at_point("rim", [2.0, 2.0], "y") + quantity("energy", "energy")


def tied(kind, fine):
    mesh = Blocks(kind, fine).rectangle("a", [0, 2], [0, 1], [8, 4]).rectangle("b", [0, 2], [1, 2], [8, 4])
    text = head(a="rock", b="steel") + fixed("a left", "b left") + table("pressure", on="b top", value=1e6)
    text += table("tie", name="t", sides=["b bottom", "a top"]) + at_point("corner", [2.0, 2.0], "y")
    text += quantity("shear", "contact_force", contact="t", direction="x")
    return mesh, text + quantity("reaction", "reaction", on="a left", direction="y") + quantity("energy", "energy")


def pull(x, y):
    return table("traction", on="top", value=[x, y])


STEPS = "[[step]]\nscale = 0.5\n[[step]]\nscale = 1.0\n"

# Parts that some scenes share, and these scenes.
SCENES = {
    "no contact": {"clamped": clamped, "angle": angle, "lame": lame, "crack, open": crack(pull(0, 1e6))},
    "contact, edges at corners": {"stack": stack(""), "pillars": pillars(""), "crack, closed": crack(pull(0, -1e6))},
    "contact, edges that move": {"foundation": foundation(), "foundation, steps": foundation("", STEPS), "stop": stop},
    "friction": {
        "stack, friction": stack("friction = 0.3"), "stack, sticks": stack("friction = 2.0"),
        "pillars, friction": pillars("friction = 0.25"), "foundation, friction": foundation("friction = 0.2"),
        "crack, friction": crack(pull(6e5, -1e6), "friction = 0.3"),
    },
    "nodes that don't match": {
        "mortar": mortar(""), "mortar, friction": mortar("friction = 0.3"), "punch": punch,
    },
    "press fit": {"shrink": shrink},
    "tie that ends at a support": {"tied": tied},
}
