"""The pictures of a result.

`overview` is the deformed shape by von Mises stress with the contact pressures on it; the others are the
seven pictures of the paper: deformation, u_x, u_y, tau_x, tau_y, tau_xy, principal stresses. In space they are
displacement, von_mises and pressure.
"""

import warnings

import numpy as np

from contact_dd.drawing import space
from contact_dd.drawing.canvas import round_below
from contact_dd.drawing.finite import check_finite
from contact_dd.drawing.gaps import honest_scale
from contact_dd.drawing.overview import overview
from contact_dd.drawing.paper import contours, deformation, principal
from contact_dd.drawing.plane import Plane
from contact_dd.errors import InputError

# The largest displacement over the size, where no scale is given.
VISIBLE = 0.06


def displacement(component, name):
    def draw(plane, _scale):
        return contours(plane, plane.displacement[:, component], f"Displacement $u_{name}$", plane.units.length)

    return draw


def stress(component, name):
    def draw(plane, _scale):
        title = f"Stress $\\sigma_{{{name}}}$ ($\\tau_{{{name}}}$ in the paper)"
        return contours(plane, plane.stress[:, component], title, plane.units.stress)

    return draw


PICTURES = {
    "overview": overview,
    "deformation": deformation,
    "u_x": displacement(0, "x"),
    "u_y": displacement(1, "y"),
    "tau_x": stress(0, "x"),
    "tau_y": stress(1, "y"),
    "tau_xy": stress(3, "xy"),
    "principal": lambda plane, _scale: principal(plane),
}


def draw(result, names=None, scale=None, circle=None):
    """Draws the pictures with these names, by default all, one after the other; those in space differ from those in
    the plane. Raises `InputError` where a number isn't finite, or for a `circle` in the plane."""
    check_finite(result)
    if result.is_in_space:
        for name in names or ["overview", *space.Solid(result).pictures()]:
            with_circle = {"circle": circle} if name == "overview" else {}
            yield name, known(space.PICTURES, name)(result, scale, **with_circle)
        return
    if circle:
        raise InputError("a circle is drawn on pressures in space; this result is in the plane")
    plane = Plane(result)
    honest = honest_scale(plane)
    scale = scale or automatic_scale(plane, honest)
    if scale > honest:
        warnings.warn(
            f"× {scale:g} enlarges gaps that close, too, so that bodies that touch are drawn one over the other or "
            f"apart; × {round_below(honest):g} isn't too much",
            stacklevel=3,
        )
    for name in names or PICTURES:
        yield name, known(PICTURES, name)(plane, scale)


def known(pictures, name):
    if name not in pictures:
        raise InputError(f"there is no picture {name!r}; expected one of {', '.join(pictures)}")
    return pictures[name]


def automatic_scale(plane, honest):
    """The round factor with which the largest displacement is about a twentieth of the size, at most `honest`."""
    largest = np.linalg.norm(plane.deformation, axis=1).max()
    return round_below(min(VISIBLE * plane.size / largest, honest)) if largest > 0 else 1.0
