"""Sketches of the cases of docs/validation.md: bodies, supports, loads and contacts; run it by scripts/sketches.

    sketches.py FOLDER [TITLE ...]

Cases that are built-in scenes are drawn from their results, the others from what the page says of them, in space by a
section."""

import pathlib
import sys

import matplotlib.pyplot as plt
import numpy as np

from sketch import DOWN, LEFT, RIGHT, UP, Sketch, arc, of_scene, parabola

# Cases that are built-in scenes.
SCENES = {
    "Patch test: matching nodes": "patch", "Junction": "junction", "Hertz: a cylinder on a plane": "hertz",
    "Raous' plate": "raous", "Plate with a hole": "plain",
}
NODES = ", 3 cells on 2"


def uneven():
    sketch = Sketch()
    turn = np.array([[np.cos(0.4), np.sin(0.4)], [-np.sin(0.4), np.cos(0.4)]])
    lower, upper = (np.array([(0, y), (2, y), (2, y + 1), (0, y + 1)]) @ turn for y in (0, 1))
    sketch.body(lower)
    sketch.body(upper)
    sketch.held(lower[:2], DOWN @ turn)
    for block in (lower, upper):
        sketch.held(block[[3, 0]], LEFT @ turn, count=3)
    sketch.loaded(upper[[3, 2]], DOWN @ turn, "p = 1 MPa")
    sketch.contact(lower[[3, 2]], "contact, 3 cells on 7")
    for count, offset in ((3, -0.05), (7, 0.05)):
        sketch.nodes(np.linspace(lower[3], lower[2], count + 1) + offset * UP @ turn)
    return sketch


def half_plane(sketch, top, rollers=True, wide=2.0, words="tractions of the exact solution"):
    """A square body below y = 0 with what the rest of a half plane does to it."""
    top = np.asarray(top, dtype=float)
    sketch.body([(0, -2), (wide, -2), *top[::-1]])
    sketch.loaded([(wide, -2), top[-1]], lambda at: LEFT * (1 + at[1] / 4) + 0.4 * UP, words, 5)
    sketch.loaded([(0, -2), (wide, -2)], lambda at: UP - 0.3 * at[0] * RIGHT, words, 5)
    if rollers:
        sketch.held([top[0], (0, -2)], LEFT)


def two_half_planes(nodes=False):
    sketch = Sketch()
    below, above = parabola([0, 2], -16), parabola([0, 2], 16)
    half_plane(sketch, below)
    sketch.body([(0, 2), (2, 2), *above[::-1]])
    sketch.held([(0, 0), (0, 2)], LEFT)
    words = "tractions of the exact solution"
    sketch.loaded([(2, 0.3), (2, 2)], lambda at: LEFT * (1 - at[1] / 4) + 0.4 * DOWN, words, 4)
    sketch.loaded([(0, 2), (2, 2)], lambda at: DOWN - 0.3 * at[0] * RIGHT, words, 5)
    words = f"contact, gap x²/8{NODES if nodes else ''}"
    sketch.contact(below, words)
    sketch.contact(above, words)
    if nodes:
        for count, line in ((8, below), (12, above)):
            x = np.linspace(0, 2, count + 1)
            sketch.nodes(np.stack([x, np.interp(x, *line.T)], axis=1))
    return sketch


def roller(friction=None):
    sketch = Sketch()
    sketch.body([(0, -200), (100, -200), (100, 0), (0, 0)])
    sketch.body([(0, 50), *arc((0, 50), 50, -90, 0)])
    sketch.held([(0, -200), (100, -200)], DOWN, "fixed")
    sketch.held([(0, -200), (0, 50)], LEFT, count=7)
    sketch.loaded([(0, 50), (50, 50)], DOWN, "P = 35 kN/mm, half of it", 4)
    at = [*arc((0, 50), 50, -90, -50)]
    sketch.contact(at, f"contact, μ = {friction}" if friction else "contact")
    sketch.contact([(0, 0), (at[-1][0], 0)], f"contact, μ = {friction}" if friction else "contact")
    sketch.text((62, 18), "R = 50 mm", ha="left")
    sketch.text((50, -100), "half of\n200 mm ×\n200 mm")
    return sketch


def crack(friction=None):
    sketch = Sketch()
    square = np.array([(-3, -3), (3, -3), (3, 3), (-3, 3)], dtype=float)
    sketch.body(square)
    push = np.array([np.cos(np.radians(20)), np.sin(np.radians(20))])
    for a, b, outward in zip(square, np.roll(square, -1, axis=0), (DOWN, RIGHT, UP, LEFT), strict=True):
        sketch.loaded([a, b], -push * (push @ outward), "σ = 100 MPa at 20° to the crack")
    sketch.contact([(-1, 0), (1, 0)], f"crack of 2 m, μ = {friction}" if friction else "crack of 2 m")
    return sketch


def pushed(is_in_space=False):
    sketch = Sketch()
    below, above = parabola([-2, 2], -16), parabola([-2, 2], 16)
    sketch.body([(-2, -2), (2, -2), *below[::-1]])
    sketch.body([(-2, 2), (2, 2), *above[::-1]])
    words = "contact, gap x²/8, μ = 0.5"
    if is_in_space:
        words = "contact, gap r²/8, μ = 0.5"
        sketch.held([(-2, -2), (2, -2)], DOWN, "prescribed displacement")
        sketch.held([(-2, 2), (2, 2)], UP, "prescribed displacement")
        sketch.loaded([(-1.2, 2), (2.4, 2)], RIGHT, "push Q", 3, pushes=False)
        sketch.text((0, -1), "section y = 0 of halves\nof cylinders of radius 2")
    else:
        sketch.held([(-2, -2)], LEFT)
        sketch.held([(-2, -2)], DOWN)
        sketch.held([(2, -2)], DOWN)
        for y, way in ((2, DOWN), (-2, UP)):
            sketch.loaded([(-2, y), (2, y)], lambda at, way=way: way * 1.5 - 0.3 * at[0] * RIGHT, "tractions of P and Q")
        for x, y, way in ((2, 1, 1), (-2, 1, 1), (2, -1, -1), (-2, -1, -1)):
            sketch.loaded([(x, y - 0.7), (x, y + 0.9 - 0.2)], way * RIGHT, "tractions of P and Q", 3, pushes=x * way < 0)
    sketch.contact(below, words)
    sketch.contact(above, words)
    return sketch


def punch(around_axis=False, is_in_space=False):
    sketch = Sketch()
    half_plane(sketch, [(0, 0), (2, 0)], rollers=not around_axis)
    sketch.rigid([(0, 0), (1, 0)], [0, 0.4])
    sketch.contact([(0, 0), (1, 0)])
    sketch.text((0.5, 0.2), "punch", bbox={"fc": "w", "ec": "none", "pad": 1})
    sketch.text((1.35, 0.2), "a = 1")
    if around_axis:
        sketch.axis([(0, -2.3), (0, 0.8)])
    if is_in_space:
        sketch.text((1.0, -1), "section y = 0 of a quarter\nof a cylinder of radius 2")
    return sketch


def ball_on_plane(is_in_space=False):
    sketch = Sketch()
    half_plane(sketch, parabola([0, 2], -16), rollers=is_in_space)
    sketch.rigid([(0, 0), (2, 0)], [0, 0.3])
    sketch.contact(parabola([0, 2], -16), "contact, gap r²/16")
    if is_in_space:
        sketch.text((1.0, -1), "section y = 0 of a quarter\nof a cylinder of radius 2")
    else:
        sketch.axis([(0, -2.3), (0, 0.7)])
    return sketch


def ball_on_ball_around_axis():
    sketch = Sketch()
    below, above = parabola([0, 2], -16), parabola([0, 2], 16)
    half_plane(sketch, below, rollers=False)
    sketch.body([(0, 2), (2, 2), *above[::-1]])
    words = "tractions of the exact solution"
    sketch.loaded([(2, 0.3), (2, 2)], lambda at: LEFT * (1 - at[1] / 4) + 0.4 * DOWN, words, 4)
    sketch.loaded([(0, 2), (2, 2)], lambda at: DOWN - 0.3 * at[0] * RIGHT, words, 5)
    for line in (below, above):
        sketch.contact(line, f"contact, gap r²/8{NODES}")
    sketch.axis([(0, -2.3), (0, 2.3)])
    return sketch


def signorini():
    sketch = Sketch()
    top = np.stack([np.linspace(0, 1, 41), np.zeros(41)], axis=1)
    sketch.body([(0, -1), (1, -1), *top[::-1]])
    sketch.rigid([(0, 0.0), (0.5, 0.0), *([x, 0.4 * (x - 0.5) ** 2] for x in np.linspace(0.5, 1, 11))], [0, 0.1])
    sketch.held([(0, 0), (0, -1)], LEFT, "prescribed displacement")
    sketch.held([(0, -1), (1, -1)], DOWN, "prescribed displacement")
    sketch.loaded([(1, -1), (1, 0)], lambda at: LEFT + (0.5 + at[1]) * UP, "tractions of the exact solution", 5)
    sketch.contact([(0, 0), (0.5, 0)], "contact, closed")
    sketch.text((0.5, -0.5), "body force of the\nexact solution")
    return sketch


def cantilever():
    sketch = Sketch()
    sketch.body([(0, -1), (8, -1), (8, 1), (0, 1)])
    sketch.held([(0, 1), (0, -1)], LEFT, "prescribed displacement", 4)
    sketch.loaded([(8, -1), (8, 1)], lambda at: DOWN * (1 - at[1] ** 2), "shear force P = 1", 3, pushes=False)
    sketch.text((4, 0), "L = 8, D = 2")
    return sketch


def ball_on_plate():
    sketch = Sketch()
    sketch.body([(0, 8), *arc((0, 8), 8, -90, 0)])
    sketch.rigid([(0, 0), (8, 0)], [0, -0.8])
    sketch.held([(0, 0.5), (0, 8)], LEFT)
    sketch.held([(0, 8), (8, 8)], UP, "prescribed displacement")
    sketch.contact(arc((0, 8), 8, -90, -70))
    sketch.text((3.2, 5.6), "R = 8; section y = 0\nof an eighth of the ball")
    return sketch


def ball_on_ball():
    sketch = Sketch()
    sketch.body([(0, 8), *arc((0, 8), 8, -90, 0)])
    sketch.body([(0, -5), *arc((0, -5), 5, 90, 0)])
    sketch.held([(0, -4.5), (0, 8)], LEFT, count=7)
    sketch.held([(0, 8), (8, 8)], UP, "prescribed displacement")
    sketch.held([(0, -5), (5, -5)], DOWN, "prescribed displacement", 4)
    sketch.contact(arc((0, 8), 8, -90, -72))
    sketch.contact(arc((0, -5), 5, 90, 62))
    sketch.text((3.4, 5.6), "R = 8")
    sketch.text((1.9, -3.6), "R = 5")
    return sketch


def layers():
    sketch = Sketch()
    for inner, outer in ((1, 1.5), (1.5, 2)):
        sketch.body([*arc((0, 0), inner, 0, 90), *arc((0, 0), outer, 90, 0)])
    sketch.held([(1, 0), (2, 0)], DOWN, count=4)
    sketch.held([(0, 1), (0, 2)], LEFT, count=4)
    sketch.loaded(arc((0, 0), 1, 0, 90), lambda at: at, "p = 1")
    sketch.contact(arc((0, 0), 1.5, 0, 90))
    sketch.text((0.25, 0.25), "section", fontsize=7)
    return sketch


def far_from_a_force():
    sketch = Sketch()
    sketch.body([*arc((0, 0), 1, 0, -90), *arc((0, 0), 4, -90, 0)])
    sketch.held([(0, -1), (0, -4)], LEFT)
    sketch.held([(0, -4)], DOWN)
    words = "tractions of the exact solution"
    sketch.loaded(arc((0, 0), 1, -10, -90), lambda at: at * abs(at[1]), words, 4)
    sketch.loaded(arc((0, 0), 4, -5, -85), lambda at: -at * abs(at[1]), words, 8)
    sketch.loaded([(0, 0)], DOWN, "P = 10, not in the model")
    sketch.text((2.3, 0.3), "free surface")
    return sketch


DRAWN = {
    "Patch test: nodes that don't match": uneven,
    "Hertz: a cylinder on a cylinder": two_half_planes,
    "Hertz: a cylinder on a cylinder, nodes that don't match": lambda: two_half_planes(nodes=True),
    "NAFEMS contact roller": roller,
    "NAFEMS contact roller with friction": lambda: roller("0.1"),
    "Closed inclined crack": crack,
    "Closed inclined crack with friction": lambda: crack("0.6"),
    "Cattaneo and Mindlin: cylinders pushed to and fro": pushed,
    "Flat rigid punch": punch,
    "Hertz around an axis: a ball on a plane": ball_on_plane,
    "Hertz around an axis: a ball on a ball, nodes that don't match": ball_on_ball_around_axis,
    "Flat round punch": lambda: punch(around_axis=True),
    "Manufactured solution of Signorini's problem": signorini,
    "Cantilever": cantilever,
    "Ball on a plate": ball_on_plate,
    "Ball on a ball": ball_on_ball,
    "Thick sphere in two layers": layers,
    "Hertz in space: a ball on a plane": lambda: ball_on_plane(is_in_space=True),
    "Flat round punch in space": lambda: punch(is_in_space=True),
    "Half space far from a force": far_from_a_force,
    "Mindlin in space: balls pushed along their contact": lambda: pushed(is_in_space=True),
}
CASES = {**{title: (lambda name=name: of_scene(name)) for title, name in SCENES.items()}, **DRAWN}


def anchor_of(title):
    """The anchor of a heading, which is the name of its sketch."""
    return "".join(c for c in title if c.isalnum() or c in "-_ ").lower().replace(" ", "-")


def main():
    folder = pathlib.Path(sys.argv[1])
    plt.rcParams.update({"svg.fonttype": "none", "svg.hashsalt": "sketches", "font.size": 8})
    for title in sys.argv[2:] or CASES:
        path = folder / f"{anchor_of(title)}.svg"
        CASES[title]().save(path)
        print(path)


if __name__ == "__main__":
    main()
