"""Draws the first error of each case of the validation over the dofs; run it by scripts/validate.

    validation.py ERRORS FOLDER     ERRORS is what studies wrote of all meshes
"""

import json
import pathlib
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

LINEAR = ("triangle3", "quad4", "tetrahedron4", "hexahedron8")
MARKERS = {"triangle": "^", "quad": "s", "tetrahedron": "v", "hexahedron": "D"}
# Errors below are round-off: patch tests, whose cases have no curve.
ROUND_OFF = 1e-9
# Axes over fewer decades have labels between powers of ten.
DECADES = 1.5
# Inches.
SIZE = (4.2, 2.6)


def is_linear(cells):
    return all(part.split(",")[0] in LINEAR for part in cells.split(" on "))


def whole(value, _):
    """A number of degrees of freedom."""
    return f"{value / 1000:g}k" if value >= 1000 else f"{value:g}"


def power(value, _):
    """An error as the tables have it: 2e-4."""
    if value >= 0.1:
        return f"{value:.2g}"
    return f"{value:.0e}".replace("e-0", "e-")


def draw(case):
    """A figure of a case: a line for each kind of cells."""
    figure, axes = plt.subplots(figsize=SIZE, layout="constrained")
    for kind in case["kinds"]:
        cells = kind["cells"]
        style = {
            "color": "#4b5866" if is_linear(cells) else "#d62728", "ls": "--" if "uniform" in cells else "-",
            "marker": next((marker for name, marker in MARKERS.items() if cells.startswith(name)), "o"),
            "mfc": "w" if cells.split(",")[0] in ("quad9", "hexahedron27") else None,
        }
        axes.loglog(kind["dofs"], kind["values"], ms=3.5, lw=0.9, label=cells, **style)
    for axis, shown, limits in ((axes.xaxis, whole, axes.get_xlim()), (axes.yaxis, power, axes.get_ylim())):
        subs = (1, 2, 5) if np.ptp(np.log10(limits)) < DECADES else (1,)
        axis.set_major_locator(LogLocator(subs=subs))
        axis.set_major_formatter(FuncFormatter(shown))
        axis.set_minor_formatter(NullFormatter())
    axes.set_xlabel("degrees of freedom")
    axes.set_ylabel(f"error: {case['kinds'][0]['figure']}")
    axes.grid(alpha=0.25, lw=0.4)
    axes.spines[["top", "right"]].set_visible(False)
    figure.legend(loc="outside right upper", frameon=False)
    return figure


def main():
    cases = json.loads(pathlib.Path(sys.argv[1]).read_text())
    plt.rcParams.update({"svg.fonttype": "none", "font.size": 8})
    for case in cases:
        if max(max(kind["values"]) for kind in case["kinds"]) > ROUND_OFF:
            plt.rcParams["svg.hashsalt"] = case["name"]
            figure = draw(case)
            figure.savefig(pathlib.Path(sys.argv[2]) / f"{case['name']}-errors.svg", metadata={"Date": None})
            plt.close(figure)


main()
