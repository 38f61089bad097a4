"""The picture of docs/theory.md: the bar that the page computes by hand, and the laws of contact and friction; run by
scripts/sketches.

    theory.py PICTURE.svg"""

import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

LAW, OTHER, LOAD, RIGID = "#d6202c", "#3b6ea5", "#a3159b", "#555555"


def hatched(axes, low, width):
    axes.bar(low, 2.0, width, -1.0, align="edge", fc="none", ec=RIGID, hatch="////", lw=0)


def bar(axes):
    """Two springs of 100 N/mm, 20 N and 10 N on their nodes, and a wall at 0.25 mm."""
    axes.set_title("The bar of this page")
    hatched(axes, -0.35, 0.35)
    axes.plot([0, 0], [-1, 1], color=RIGID, lw=1.4)
    for start in (0, 2):
        x = np.concatenate([[0, 0.35], np.linspace(0.45, 1.55, 8), [1.65, 2.0]])
        y = np.concatenate([[0, 0], 0.22 * np.where(np.arange(8) % 2, -1, 1), [0, 0]])
        axes.plot(start + x, y, color="k", lw=1.1)
        axes.text(start + 1, 0.38, "k = 100 N/mm", ha="center", fontsize=7.5)
    for node, force, name in ((2, 20, "u₁"), (4, 10, "u₂")):
        axes.plot(node, 0, "o", color="k", ms=5)
        axes.text(node, -0.42, name, ha="center")
        # Forces below their nodes, the wall being behind the second one.
        arrow = {"color": LOAD, "arrowstyle": "-|>", "lw": 1.6}
        axes.annotate("", (node + 0.2, -0.9), (node - 0.9, -0.9), arrowprops=arrow)
        axes.text(node - 0.35, -0.78, f"{force} N", ha="center", color=LOAD)
    hatched(axes, 4.55, 0.35)
    axes.plot([4.55, 4.55], [-1, 1], color=RIGID, lw=1.4)
    arrow = {"arrowstyle": "<|-|>", "lw": 0.8, "color": "k", "shrinkA": 0, "shrinkB": 0}
    axes.annotate("", (4.55, 0.72), (4, 0.72), arrowprops=arrow)
    axes.plot([4, 4], [0.1, 0.8], color="0.6", lw=0.6)
    axes.text(4.05, 0.84, "g = 0.25 mm", ha="center", fontsize=7.5)
    axes.set(xlim=(-0.5, 5.0), ylim=(-1.1, 1.1))
    axes.axis("off")


def cross(axes, title, x, y):
    """Axes through the origin, with their names at the ends."""
    axes.set_title(title)
    axes.axhline(0, color="k", lw=0.7)
    axes.axvline(0, color="k", lw=0.7)
    axes.text(1.12, -0.06, x, ha="right", va="top", fontsize=8)
    axes.text(0.04, 1.1, y, ha="left", va="top", fontsize=8)
    axes.set_xticks([])
    axes.set_yticks([])
    axes.spines[:].set_visible(False)


def contact(axes):
    cross(axes, "Contact", "gap left\ng − n·⟦u⟧", "pressure p")
    axes.plot([0, 0, 1], [1, 0, 0], color=LAW, lw=2.4, solid_joinstyle="miter", label="law")
    axes.plot([-0.35, 0, 1], [1, 0, 0], color=OTHER, lw=1.2, ls="--", label="penalty")
    axes.text(-0.42, 0.45, "pene-\ntration", ha="center", color=OTHER, fontsize=7.5)
    axes.set(xlim=(-0.7, 1.12), ylim=(-0.3, 1.12))
    axes.legend(frameon=False, fontsize=7.5, loc="center right")


def friction(axes):
    cross(axes, "Friction", "slip Δw", "force λ_t")
    bounds = [-0.7, -0.7, 0.7, 0.7]
    axes.plot([-1, 0, 0, 1], bounds, color=LAW, lw=2.4, solid_joinstyle="miter", label="law")
    axes.plot([-1, -0.25, 0.25, 1], bounds, color=OTHER, lw=1.2, ls="--", label="penalty")
    axes.text(-0.08, 0.3, "sticks", ha="right", fontsize=7.5)
    axes.text(0.62, 0.78, "slips", fontsize=7.5, ha="center")
    axes.text(-0.06, 0.7, "s", ha="right", va="center")
    axes.text(0.06, -0.7, "−s", ha="left", va="center")
    axes.set(xlim=(-1.12, 1.12), ylim=(-1.12, 1.12))
    axes.legend(frameon=False, fontsize=7.5, loc="lower right", bbox_to_anchor=(1.08, 0.08))


def main():
    plt.rcParams.update({"svg.fonttype": "none", "svg.hashsalt": "theory", "font.size": 9, "axes.titlesize": 9})
    figure, panels = plt.subplots(1, 3, figsize=(9.6, 2.5), width_ratios=(2.1, 1, 1), layout="constrained")
    for draw, axes in zip((bar, contact, friction), panels, strict=True):
        draw(axes)
    figure.savefig(sys.argv[1], metadata={"Date": None})
    print(sys.argv[1])


main()
