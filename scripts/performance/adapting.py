"""Measures meshes that adapt against uniform ones and writes docs/adapting.md; run it by scripts/adapting."""

import math
import os
import pathlib
import resource
import subprocess
import sys
import tempfile
import warnings

import gmsh
import matplotlib

matplotlib.use("svg")
import matplotlib.pyplot as plt
import numpy as np

root = pathlib.Path(__file__).resolve().parents[2]
sys.path[:0] = [str(root / "python"), str(root / "python/tests")]

from contact_dd import Model, adapt, programs
from contact_dd.mesh import of_gmsh
from contact_dd.sizes import relative_errors
from hertz import true_error
from runs import measured as day_and_commit

ASKED = {"hertz": [1e-2, 1e-3, 1e-4], "granite": [2e-2, 1e-2, 1e-3], "mindlin": [3e-2, 1e-2]}
COARSEST = {"hertz": 0.5, "granite": 1.0, "mindlin": 2.0}
MOST_DOFS = 400_000
NAMES = {"hertz": "Hertz", "granite": "Granite", "mindlin": "Mindlin"}
WHAT = {"hertz": "Hertz: a smooth field", "granite": "Granite: crack tips", "mindlin": "Mindlin: friction"}


def processor_time():
    """Of this process, in which Gmsh meshes, and of the programs that it started (s)."""
    both = (resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN))
    return sum(used.ru_utime + used.ru_stime for used in both)


def geometry(name):
    return root / f"scripts/performance/geometries/{name}.geo"


def scene(name, folder):
    command = [programs.find("contact-dd-partition"), "--example", name, "--write-scene", folder]
    subprocess.run(command, check=True, capture_output=True)
    return Model.from_scene(pathlib.Path(folder, "scene.toml"))


def uniform(name, model):
    """Dofs, result and time of finer and finer uniform meshes of quadratic cells."""
    size = COARSEST[name]
    while True:
        start = processor_time()
        gmsh.initialize(interruptible=False)
        gmsh.option.setNumber("General.Terminal", 0)
        gmsh.open(str(geometry(name)))
        for key, value in {"SizeMax": size, "SizeMin": size}.items():
            gmsh.option.setNumber(f"Mesh.Mesh{key}", value)
        gmsh.model.mesh.generate(2)
        gmsh.model.mesh.setOrder(2)
        model.mesh = of_gmsh()
        gmsh.finalize()
        result = model.run(1, progress=False)
        yield result, processor_time() - start
        if 4 * result.report["dofs"] > MOST_DOFS:
            return
        size /= 2


def norm2(result):
    return result.report["error_estimate"]["energy_norm"] ** 2


def at(asked, errors, times):
    """The time at an error, and whether it is beyond what was measured; along straight lines in logarithms."""
    x, y = np.log(errors[::-1]), np.log(times[::-1])
    if asked >= errors[-1]:
        return math.exp(np.interp(math.log(asked), x, y)), False
    slope = (y[0] - y[1]) / (x[0] - x[1])
    return math.exp(y[0] + slope * (math.log(asked) - x[0])), True


def measured(name):
    """For every error that is asked dofs, rounds, estimate, true error and time; and the uniform meshes."""
    with tempfile.TemporaryDirectory() as folder:
        model = scene(name, folder)
        adapted = []
        for asked in ASKED[name]:
            start = processor_time()
            result, rounds = adapt(model, asked, geometry(name), ranks=1, progress=False)
            adapted.append((asked, result, rounds, processor_time() - start))
            print(name, asked, rounds[-1], flush=True)
        fine = list(uniform(name, model))
        if name == "granite":
            # ‖u − u_h‖² = ‖u‖² − ‖u_h‖²; of the finest mesh the estimate has to do.
            finest, _ = adapt(model, ASKED[name][-1] / 3, geometry(name), ranks=1)
            exact = norm2(finest) + finest.report["error_estimate"]["error"] ** 2

        def error_of(result):
            if name == "hertz":
                return true_error(result)
            if name == "granite":
                return math.sqrt(max(exact - norm2(result), 0) / exact)
            return relative_errors(result)[0]

        rows = [(asked, result, rounds, error_of(result), time) for asked, result, rounds, time in adapted]
        return rows, [(result.report["dofs"], error_of(result), time) for result, time in fine]


def other_time(asked, fine):
    """The time of the uniform mesh that has an error, and how the page shows it."""
    other, is_beyond = at(asked, *(np.array(column) for column in list(zip(*fine))[1:]))
    return other, f"{'about ' * is_beyond}{other:.2g}" if other < 1000 else "over 1000"


def short(measurements):
    """For users: the time of adapted meshes beside that of the one uniform mesh with the same error, and the faster."""
    lines = ["| | error asked | adapted, s | uniform, s | faster |", "|---|--:|--:|--:|---|"]
    for name, (rows, fine) in measurements.items():
        for asked, _, _, _, time in rows:
            other, found = other_time(asked, fine)
            faster = "adapted" if time < other else "uniform"
            lines.append(f"| {WHAT[name]} | {asked:.2%} | {time:.1f} | {found} | {faster} |")
    return "\n".join(lines)


def table(measurements):
    lines = [
        "| | asked | meshes | dofs | estimated | true | s | uniform, s | ratio |",
        "|---|--:|--:|--:|--:|--:|--:|--:|--:|",
    ]
    for name, (rows, fine) in measurements.items():
        for asked, result, rounds, true, time in rows:
            cells = [NAMES[name], f"{asked:.2%}", len(rounds), result.report["dofs"], f"{rounds[-1].error:.3%}"]
            other, found = other_time(asked, fine)
            cells += ["" if name == "mindlin" else f"{true:.3%}", f"{time:.1f}", found]
            cells.append(f"{time / other:.2g}" if other < 1000 else "below 0.01")
            lines.append("| " + " | ".join(map(str, cells)) + " |")
    return "\n".join(lines)


def draw(measurements, path):
    plt.rcParams.update({"svg.fonttype": "none", "svg.hashsalt": "adapting", "font.size": 9})
    figure, panels = plt.subplots(1, len(measurements), figsize=(8.4, 3.2), layout="constrained", sharey=True)
    for axes, (name, (rows, fine)) in zip(panels, measurements.items()):
        axes.loglog([row[2] for row in fine], [row[1] for row in fine], "o-", color="0.5", ms=4, label="uniform")
        axes.loglog([row[4] for row in rows], [row[3] for row in rows], "o-", color="#d6202c", ms=4, label="adapted")
        axes.set_title(NAMES[name], loc="left")
        axes.set_xlabel("time of all meshes [s]")
        axes.grid(alpha=0.3, which="both", lw=0.4)
    panels[0].set_ylabel("error in the energy norm")
    panels[-1].legend(frameon=False)
    figure.savefig(path, metadata={"Date": None})


def page(measurements):
    mindlin = measurements["mindlin"][0][-1][1].report
    pressure, work = mindlin["contacts"][0]["largest_pressure"], mindlin["friction"]["dissipated_work"]
    template = (root / "scripts/performance/adapting.md").read_text()
    return (
        template.replace("TABLE", table(measurements)).replace("SHORT", short(measurements))
        .replace("PRESSURE", f"{pressure:.1f}").replace("WORK", f"{work:.5f}").replace("LOAD", f"{os.getloadavg()[0]:.1f}")
        .replace("MEASURED", day_and_commit())
    )


def main():
    warnings.simplefilter("ignore")
    measurements = {name: measured(name) for name in ASKED}
    draw(measurements, root / "docs/figures/adapting.svg")
    (root / "docs/adapting.md").write_text(page(measurements))


main()
