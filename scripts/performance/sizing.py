"""Memory and processor time of built-in scenes on one rank, and what --check expects: the tables of docs/sizing.md."""

import argparse
import json
import math
import os
import pathlib
import re
import subprocess
import tempfile

from runs import measured

PAGE = pathlib.Path("docs/sizing.md")
PROGRAMS = pathlib.Path(os.environ["CONTACT_DD_BIN"]).resolve()
# Name in the table, scene with its options on several meshes, what to add to every contact of it.
FAMILIES = [
    ("plane, triangle3", "--example granite", (2, 3, 4), ""),
    ("plane, triangle6", "--example granite --element triangle6", (1, 2, 3), ""),
    ("plane, triangle6, friction", "--example granite-friction --element triangle6", (1, 2, 3), ""),
    ("plane, quad8, mortar", "--example rollers --element quad8", (0, 1, 2), ""),
    ("space, hexahedron8", "--example cube-crack", (0, 1, 2), ""),
    ("space, hexahedron8, friction", "--example cube-crack", (0, 1), "friction = 0.3\n"),
    ("space, hexahedron20", "--example cube-crack --element hexahedron20", (0, 1), ""),
    ("space, hexahedron27", "--example sphere", (0, 1), ""),
    ("space, tetrahedron4", "--example cube-crack --element tetrahedron4", (0, 1, 2), ""),
    ("space, tetrahedron10", "--example cube-crack --element tetrahedron10", (0, 1), ""),
    ("space, hexahedron27, mortar", "--example pin", (0, 1), ""),
]
HEAD = (
    "| | dofs | conditions | interface | processor time, s | memory, GB | `--check` says, GB | memory a dof, kB |\n"
    "|---|--:|--:|---|--:|--:|--:|--:|\n"
)
GROWTH_HEAD = "| | memory grows as dofs to the power | time |\n|---|--:|--:|\n"


def run(folder, *command):
    """What a program prints, and its processor time."""
    before = os.times()
    done = subprocess.run([PROGRAMS / command[0], *command[1:]], cwd=folder, capture_output=True, text=True)
    after = os.times()
    if done.returncode != 0:
        raise SystemExit(f"{' '.join(map(str, command))}: {done.stderr}")
    seconds = after.children_user + after.children_system - before.children_user - before.children_system
    return done.stdout, seconds


def measure(options, refine, addition):
    """Degrees of freedom, conditions, interface solver, seconds, memory and expected memory (GB)."""
    with tempfile.TemporaryDirectory() as folder:
        options = [*options.split(), "--refine", str(refine)]
        if addition:
            run(folder, "contact-dd-partition", *options, "--write-scene", "scene")
            scene = pathlib.Path(folder, "scene/scene.toml")
            scene.write_text(scene.read_text().replace("[[contact]]\n", f"[[contact]]\n{addition}"))
            options = ["scene/scene.toml"]
        run(folder, "contact-dd-partition", *options, "-o", "problem.h5")
        checked, _ = run(folder, "contact-dd-mpi", "problem.h5", "--check")
        expected = float(re.search(r"^ +memory +([\d.]+) GB", checked, re.M)[1])
        _, seconds = run(folder, "contact-dd-mpi", "problem.h5", "--quiet", "--report", "report.json")
        report = json.loads(pathlib.Path(folder, "report.json").read_text())
    solver = report["interface_solver"]
    return report["dofs"], report["contact_conditions"], solver, seconds, report["peak_memory_bytes"] / 1e9, expected


def tables(only):
    rows, growth = "", ""
    for name, options, meshes, addition in FAMILIES:
        if only and only not in name:
            continue
        found = [measure(options, refine, addition) for refine in meshes]
        for dofs, conditions, solver, seconds, memory, expected in found:
            rows += (
                f"| {name} | {dofs} | {conditions} | {solver} | {seconds:.3g} | {memory:.2g} | {expected:.2g} "
                f"| {1e6 * memory / dofs:.2g} |\n"
            )
            print(rows.splitlines()[-1], flush=True)
        (first, *_, t, m, _), (last, *_, u, n, _) = found[-2], found[-1]
        power = math.log(last / first)
        growth += f"| {name} | {math.log(n / m) / power:.2f} | {math.log(u / t) / power:.2f} |\n"
    return HEAD + rows + "\n" + GROWTH_HEAD + growth


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--only", default="")
    only = parser.parse_args().only
    written = tables(only)
    if only:
        print(written)
        return
    before, rest = PAGE.read_text().split("<!-- measured -->\n", 1)
    _, after = rest.split("<!-- end of what is measured -->\n", 1)
    before = re.sub(r"(?m)^Measured on .*$", f"{measured()}.", before)
    head = "## Measured\n\nOne rank, processor time of the whole run.\n\n"
    PAGE.write_text(f"{before}<!-- measured -->\n\n{head}{written}\n<!-- end of what is measured -->\n{after}")


main()
