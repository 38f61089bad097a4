"""Draws error over run time, and over the tolerance; run it by scripts/accuracy."""

import json
import pathlib
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
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
        finish(axes, f"{scene}, {meshes}", "ms, whole run, 1 rank", "")
    panels[0].set_ylabel("error in the energy")
    # Columns of one element.
    names = [(element, mesh) for element in COLORS for mesh in ("uniform", "graded")]
    lines = [named[name] for name in names]
    labels = [", ".join(name) for name in names]
    figure.legend(lines, labels, loc="outside lower center", ncol=5, frameon=False)
    figure.savefig(path, metadata={"Date": None})


def draw_tolerances(tried, default, path):
    figure, axes = plt.subplots(figsize=(6.4, 4.2), layout="constrained")
    named = {}
    for mesh in tried:
        residuals = [end["residual"] for end in mesh["stopped"]]
        shifts = [max(abs(end["error"] / mesh["error"] - 1), 1e-16) for end in mesh["stopped"]]
        dashes = "-" if mesh["scene"] == "Hertz" else ":"
        (line,) = axes.plot(residuals, shifts, dashes, color=COLORS[mesh["element"]], lw=0.8)
        named.setdefault(mesh["element"], line)
    axes.axhline(1e-2, color="black", lw=0.8, ls=":")
    axes.axvline(default, color="black", lw=0.8)
    finish(
        axes, "Hertz (solid) and Signorini (dotted)", "residual at the end of the sweeps", "change of the error, over it"
    )
    axes.text(default * 1.3, axes.get_ylim()[1] / 2, "default", va="top")
    figure.legend(named.values(), named.keys(), loc="outside lower center", ncol=5, frameon=False)
    figure.savefig(path, metadata={"Date": None})


def main():
    measurements, folder = json.loads(pathlib.Path(sys.argv[1]).read_text()), pathlib.Path(sys.argv[2])
    plt.rcParams.update({"svg.fonttype": "none", "svg.hashsalt": "accuracy", "font.size": 9})
    draw_times(measurements["timed"], folder / "accuracy.svg")
    draw_tolerances(measurements["tried"], measurements["default_tolerance"], folder / "accuracy-tolerance.svg")


main()
