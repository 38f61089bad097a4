"""Draws the errors of all cases of the validation over the degrees of freedom; run it by scripts/validate."""

import json
import pathlib
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

COLUMNS = 4
LINEAR = ("triangle3", "quad4", "tetrahedron4", "hexahedron8")
# Errors below are round-off: patch tests, whose cases have no curve.
ROUND_OFF = 1e-9


def is_linear(cells):
    return all(part.split(",")[0] in LINEAR for part in cells.split(" on "))


def main():
    cases = json.loads(pathlib.Path(sys.argv[1]).read_text())
    cases = [case for case in cases if max(max(kind["values"]) for kind in case["kinds"]) > ROUND_OFF]
    plt.rcParams.update({"svg.fonttype": "none", "svg.hashsalt": "validation", "font.size": 7})
    rows = -(-len(cases) // COLUMNS)
    size = {"figsize": (2.6 * COLUMNS, 1.9 * rows), "layout": "constrained", "squeeze": False}
    figure, panels = plt.subplots(rows, COLUMNS, **size)
    for case, axes in zip(cases, panels.flat):
        for kind in case["kinds"]:
            color, name = ("#4b5866", "linear cells") if is_linear(kind["cells"]) else ("#d62728", "quadratic cells")
            dashes = "--" if "uniform" in kind["cells"] else "-"
            axes.loglog(kind["dofs"], kind["values"], "o" + dashes, color=color, ms=2.5, lw=0.9, label=name)
        title = case["title"] if len(case["title"]) < 44 else case["title"][:42] + "…"
        axes.set_title(title, fontsize=7, loc="left")
        axes.set_ylabel(case["kinds"][0]["figure"])
        axes.grid(alpha=0.25, lw=0.4)
        axes.spines[["top", "right"]].set_visible(False)
        axes.minorticks_off()
    for axes in panels.flat[len(cases) :]:
        axes.set_visible(False)
    named = {}
    for axes in panels.flat[: len(cases)]:
        named |= dict(zip(axes.get_legend_handles_labels()[1], axes.get_legend_handles_labels()[0]))
    figure.supxlabel("degrees of freedom (dashed: uniform meshes)")
    figure.legend(named.values(), named.keys(), loc="outside upper center", ncol=2, frameon=False)
    figure.savefig(sys.argv[2], metadata={"Date": None})


main()
