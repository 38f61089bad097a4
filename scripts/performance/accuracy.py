"""Draws error over run time, and over the tolerance; run it by scripts/accuracy."""

import json
import pathlib
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.ticker import NullFormatter

COLORS = {
    "triangle3": "#9aa5b1",
    "quad4": "#4b5866",
    "triangle6": "#ff9d4d",
    "quad8": "#d62728",
    "quad9": "#1f5fa8",
}
MARKS = {"triangle3": "^", "quad4": "s", "triangle6": "^", "quad8": "s", "quad9": "o"}


def series(rows):
    """Rows of one scene, element and mesh, in the order of the file."""
    groups = {}
    for row in rows:
        groups.setdefault((row["scene"], row["element"], row["mesh"]), []).append(row)
    return groups


def finish(axes, title, x, y):
    axes.set_title(title)
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.xaxis.set_minor_formatter(NullFormatter())
    axes.set_xlabel(x)
    axes.set_ylabel(y)
    axes.grid(alpha=0.25, lw=0.5)
    axes.spines[["top", "right"]].set_visible(False)


def draw_times(rows, path):
    scenes = list(dict.fromkeys(row["scene"] for row in rows))
    size = {"figsize": (4.9 * len(scenes), 4.6), "layout": "constrained", "sharex": True, "sharey": True}
    figure, panels = plt.subplots(1, len(scenes), **size)
    named = {}
    for scene, axes in zip(scenes, panels):
        for (of, element, mesh), own in series(rows).items():
            if of != scene:
                continue
            times = [1e3 * row["seconds"][0]["total"] for row in own]
            errors = [row["errors"][0] for row in own]
            dashes, fill = ("--", "white") if mesh == "uniform" else ("-", COLORS[element])
            (line,) = axes.plot(
                times, errors, MARKS[element] + dashes, color=COLORS[element], ms=4, lw=1.2, mfc=fill
            )
            named[element, mesh] = line
        axes.axhline(1e-2, color="black", lw=0.8, ls=":")
        meshes = " and ".join(dict.fromkeys(mesh for of, _, mesh in series(rows) if of == scene))
        finish(axes, f"{scene}, {meshes}", "time of the run, 1 rank [ms]", "")
    panels[0].set_ylabel("error in the energy")
    # Columns of one element.
    names = [(element, mesh) for element in COLORS for mesh in ("uniform", "graded")]
    lines = [named[name] for name in names]
    labels = [", ".join(name) for name in names]
    figure.legend(lines, labels, loc="outside lower center", ncol=5, frameon=False)
    figure.savefig(path, metadata={"Date": None})


KINDS = {
    "linear cells": (("triangle3", "quad4"), "#4b5866"),
    "quadratic cells": (("triangle6", "quad8", "quad9"), "#d62728"),
}


def draw_tolerances(tried, default, path):
    """The median of all meshes of linear and of quadratic cells, and between which lines all of them lie."""
    figure, axes = plt.subplots(figsize=(6.4, 4.2), layout="constrained")
    residuals = np.linspace(-15.5, -2, 55)
    for name, (elements, color) in KINDS.items():
        curves = []
        for mesh in tried:
            if mesh["element"] in elements:
                ends = sorted((end["residual"], abs(end["error"] / mesh["error"] - 1)) for end in mesh["stopped"])
                x, y = np.log10(np.maximum(np.array(ends).T, 1e-16))
                curves.append(np.interp(residuals, x, y, left=np.nan, right=np.nan))
        of_most = np.isfinite(curves).mean(axis=0) >= 0.5
        at, shown = 10.0 ** residuals[of_most], 10.0 ** np.array(curves)[:, of_most]
        axes.fill_between(at, np.nanmin(shown, axis=0), np.nanmax(shown, axis=0), color=color, alpha=0.2, lw=0)
        label = f"{name}: median of {len(curves)} meshes, and all"
        axes.plot(at, np.nanmedian(shown, axis=0), color=color, lw=1.6, label=label)
    axes.axhline(1e-2, color="black", lw=0.8, ls=":")
    axes.axvline(default, color="black", lw=0.8)
    finish(axes, "Hertz and Signorini", "residual at the end of the sweeps", "change of the error, relative to it")
    axes.text(default * 1.3, axes.get_ylim()[1] / 2, "default", va="top")
    axes.legend(frameon=False, loc="lower right")
    figure.savefig(path, metadata={"Date": None})


def main():
    measurements, folder = json.loads(pathlib.Path(sys.argv[1]).read_text()), pathlib.Path(sys.argv[2])
    plt.rcParams.update({"svg.fonttype": "none", "svg.hashsalt": "accuracy", "font.size": 9})
    draw_times(measurements["timed"], folder / "accuracy.svg")
    draw_tolerances(measurements["tried"], measurements["default_tolerance"], folder / "accuracy-tolerance.svg")


main()
