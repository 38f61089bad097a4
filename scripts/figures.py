"""Draws the pictures of a result file; run it by scripts/figures.

`overview` is the deformed shape by von Mises stress with the contact pressures on it; the others are the
seven pictures of the paper: deformation, u_x, u_y, tau_x, tau_y, tau_xy, principal stresses.
"""

import argparse
import pathlib
import signal
import sys

import numpy as np

from drawing import space
from drawing.canvas import round_below
from drawing.gaps import honest_scale
from drawing.overview import overview
from drawing.paper import contours, deformation, principal
from drawing.result import Result

# The largest displacement over the size, as `auto` draws it.
VISIBLE = 0.06


def automatic_scale(result, honest):
    """The round factor with which the largest displacement is about a twentieth of the size, at most `honest`."""
    largest = np.linalg.norm(result.displacement, axis=1).max()
    return round_below(min(VISIBLE * result.size / largest, honest)) if largest > 0 else 1.0


def displacement(component, name):
    def draw(result, _scale, path):
        contours(result, result.displacement[:, component], f"Displacement $u_{name}$", result.units.length, path)

    return draw


def stress(component, name):
    def draw(result, _scale, path):
        contours(result, result.stress[:, component], f"Stress $\\tau_{{{name}}}$", result.units.stress, path)

    return draw


PICTURES = {
    "overview": overview,
    "deformation": deformation,
    "u_x": displacement(0, "x"),
    "u_y": displacement(1, "y"),
    "tau_x": stress(0, "x"),
    "tau_y": stress(1, "y"),
    "tau_xy": stress(3, "xy"),
    "principal": lambda result, _scale, path: principal(result, path),
}


def factor(text):
    if text == "auto":
        return None
    try:
        value = float(text)
    except ValueError:
        value = 0.0
    if not 0 < value < np.inf:
        raise argparse.ArgumentTypeError(f"'{text}' is no enlargement; expected 'auto' or a number above 0")
    return value


def folder(arguments):
    """Where the pictures go."""
    outdir = arguments.outdir or arguments.result.parent / "figures"
    try:
        outdir.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        sys.exit(f"figures: {outdir}: can't be made: {error.strerror}")
    return outdir


def in_space(arguments):
    """Draws the overview, the only picture of a result in space."""
    space.overview(arguments.result, arguments.step or 1, arguments.scale, folder(arguments) / "overview.png")


def main():
    # Where nobody reads on, as behind `| head`, there is nothing more to do.
    signal.signal(signal.SIGPIPE, signal.SIG_DFL)
    parser = argparse.ArgumentParser(prog="figures", description=__doc__.splitlines()[0])
    parser.add_argument("result", type=pathlib.Path, help="result file of contact-dd-mpi")
    parser.add_argument("outdir", type=pathlib.Path, nargs="?", help="folder (default: figures beside the result)")
    parser.add_argument("--scale", type=factor, default="auto", help="enlargement of the deformation (default: auto, which shows it, unless closed contacts would seem to overlap)")
    parser.add_argument("--only", nargs="+", choices=PICTURES, default=list(PICTURES), metavar="PICTURE", help=f"which to draw (default: all of {', '.join(PICTURES)})")
    parser.add_argument("--step", type=int, help="number of the load step, from 1 (default: the last)")
    arguments = parser.parse_args()
    try:
        if space.is_in_space(arguments.result):
            return in_space(arguments)
        result = Result(arguments.result, arguments.step)
    except FileNotFoundError:
        sys.exit(f"figures: {arguments.result}: there is no such file")
    except (OSError, KeyError):
        sys.exit(f"figures: {arguments.result}: isn't a result of contact-dd-mpi, a file .vtkhdf")
    honest = honest_scale(result)
    scale = arguments.scale or automatic_scale(result, honest)
    if scale > honest:
        print(f"figures: × {scale:g} enlarges gaps that close, too, so that bodies that touch are drawn one over the "
              f"other or apart; × {round_below(honest):g} isn't too much", file=sys.stderr)
    outdir = folder(arguments)
    for name in arguments.only:
        PICTURES[name](result, scale, outdir / f"{name}.png")


if __name__ == "__main__":
    main()
