"""Pictures of the worked examples of docs/trust.md; run it by scripts/worked-examples.

    worked_examples.py FOLDER
"""

import subprocess
import sys
from pathlib import Path

import matplotlib

matplotlib.use("agg")
from contact_dd import Result
from contact_dd.drawing.canvas import save
from matplotlib.patches import Circle

FIGURES = Path(__file__).resolve().parents[2] / "docs/figures"
# Radius of the ball and its modulus, of the scene sphere.
RADIUS, MODULUS = 8.0, 200.0 / (1 - 0.3**2)


def run(folder, *command):
    subprocess.run(command, cwd=folder, check=True)


def solved(folder, name, source):
    """The result of a problem, whose words for the partition tool `source` tells; computed where there is none."""
    result = folder / f"{name}.vtkhdf"
    if not result.is_file():
        run(folder, "contact-dd-partition", *source(), "-o", f"{name}.h5")
        run(folder, "contact-dd-mpi", f"{name}.h5")
    return Result(result)


def ball(folder):
    """The ball on a plate, with the circle of Hertz around what presses."""
    result = solved(folder, "ball", lambda: ["--example", "sphere", "--refine", "2"])
    # An eighth of the ball carries a quarter of its force.
    force = 4 * result.contacts["plate"]["force"].sum()
    a = (3 * force * RADIUS / (4 * MODULUS)) ** (1 / 3)
    figure = result.plot()
    axes = next(axes for axes in figure.findobj(matplotlib.axes.Axes) if axes.get_title().startswith("plate"))
    circle = Circle((0, 0), a, fill=False, ec="#1746a2", lw=1.4, ls="--", label=f"Hertz: a = {a:.3f} m")
    axes.add_patch(circle)
    axes.legend(handles=[circle], loc="upper right", fontsize=8)
    save(figure, FIGURES / "ball.png")


def main():
    folder = Path(sys.argv[1])
    folder.mkdir(parents=True, exist_ok=True)
    ball(folder)


main()
