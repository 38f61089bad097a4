"""Measures contact-dd-mpi in space against conjugate gradients with GAMG on two boxes of tetrahedra; run it by
scripts/bench --dim 3.

Every repetition runs all of them one after the other, on 2 ranks; a ratio is the median of the repetitions' ratios, a time
the median of the times.
"""

import glob
import json
import os
import pathlib
import shlex
import statistics
import sys
import time

import h5py
import numpy as np
import options
import runs

HERE = pathlib.Path(__file__).parent
# Where Debian keeps petsc4py.
PETSC = "/usr/lib/petscdir/petsc*/*-real/lib/python3/dist-packages"
# Difference of the largest displacements, relative, between solutions of the same problem.
LARGEST_DIFFERENCE = 1e-6


def gamg(cells, tied):
    """The output of gamg.py on 2 ranks."""
    found = sorted(glob.glob(PETSC))
    if not found:
        sys.exit("bench: petsc4py isn't there; on Debian: apt-get install python3-petsc4py python3-scipy")
    launcher = shlex.split(os.environ.get("MPIEXEC", "mpirun"))
    # Debian's Python, which its petsc4py is for.
    command = ["env", f"PYTHONPATH={found[-1]}", "OMP_NUM_THREADS=1", *launcher, "-n", 2, "/usr/bin/python3"]
    return json.loads(runs.call([*command, HERE / "gamg.py", cells, *["tied"] * tied]))


def ours(path, programs):
    """The report of a run on 2 ranks, with the largest displacement."""
    result = runs.FOLDER / "result.vtkhdf"
    report = runs.solve(path, 2, programs, result)
    with h5py.File(result) as file:
        u = file["VTKHDF/PointData/Displacement"][:]
    result.unlink()
    return {**report, "largest": float(np.linalg.norm(u, axis=1).max())}


def measure(cells, arguments):
    """The linear problem and the contact problem of one size."""
    folder = runs.FOLDER / "meshes"
    if not (folder / f"boxes-{cells}.toml").exists():
        runs.say(f"meshing boxes of {cells} cells")
        runs.call([sys.executable, HERE / "boxes.py", cells, folder])
    measured = []
    for tied in (True, False):
        path = runs.partitioned(folder / f"boxes-{cells}{'-tied' * tied}.toml", arguments.programs)
        repetitions = []
        for repetition in range(arguments.repeat):
            both = {"ours": ours(path, arguments.programs), "GAMG": gamg(cells, tied)}
            repetitions.append(both)
            mine, theirs = both["ours"], both["GAMG"]
            runs.say(f"{path.stem}, {repetition + 1} of {arguments.repeat}: ours {mine['seconds']['total']:.2f} s, "
                     f"GAMG {theirs['total']:.2f} s")
            if abs(mine["largest"] / theirs["largest"] - 1) > LARGEST_DIFFERENCE or mine["active_contacts"] != theirs["closed"]:
                sys.exit(f"bench: one of the answers is wrong: the largest displacements are {mine['largest']} and "
                         f"{theirs['largest']}, {mine['active_contacts']} and {theirs['closed']} conditions are closed")
        measured.append({"tied": tied, "repetitions": repetitions})
    return measured


def row(problem):
    """The table's row of a problem."""
    mine = [repetition["ours"] for repetition in problem["repetitions"]]
    theirs = [repetition["GAMG"] for repetition in problem["repetitions"]]
    total = statistics.median(run["seconds"]["total"] for run in mine)
    ratio = statistics.median(a["seconds"]["total"] / b["total"] for a, b in zip(mine, theirs))
    first, other = mine[0], theirs[0]
    return [
        "linear" if problem["tied"] else "contact",
        f"{first['dofs']:,}".replace(",", " "),
        first["contact_conditions"],
        first["interface_solver"],
        f"{total:.2f}",
        f"{statistics.median(run['total'] for run in theirs):.2f}",
        f"{ratio:.2f}",
        f"{2e6 * total / first['dofs']:.0f}",
        f"{max(run['peak_memory_bytes'] for run in mine) / 1e9:.2f}",
        sum(first["interface_iterations"]),
        other["iterations"],
    ]


def main():
    arguments = options.space(sys.argv[1:])
    runs.FOLDER.mkdir(parents=True, exist_ok=True)
    print(f"{time.strftime('%Y-%m-%d')}, {runs.machine()}. Medians of {arguments.repeat}, times in s, 2 ranks.\n")
    heads = ["problem", "dofs", "conditions", "interface", "whole run", "CG + GAMG", "ratio", "µs a dof and rank",
             "memory, GB", "iterations", "of GAMG"]
    print("| " + " | ".join(heads) + " |")
    print("|---|" + "--:|" * (len(heads) - 1))
    for cells in arguments.cells:
        for problem in measure(cells, arguments):
            print("| " + " | ".join(map(str, row(problem))) + " |", flush=True)


main()
