"""Checks the stated errors of quantities against much finer meshes; run it by scripts/quantity-errors, whose table is
on docs/trust.md."""

import json
import os
import pathlib
import sys
import tempfile

from quantity_scenes import SCENES
from runs import call, measured, say

PROGRAMS = pathlib.Path(os.environ["PROGRAMS"])
# Cells along sides, relative to the coarsest mesh: of the meshes, and of the two that stand for the truth.
MESHES = (1, 2, 4)
FINEST = {"quad4": (16, 32), "quad8": (8, 16)}
# Largest difference of the two finest meshes over a true error, and least error over the value.
UNCERTAIN, LEAST = 0.4, 1e-7


def solved(scene, kind, fine):
    """The quantities of a scene on a mesh, in every load step."""
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        mesh, text = scene(kind, fine)
        mesh.write(folder / "scene.msh")
        (folder / "scene.toml").write_text("mesh = 'scene.msh'\n" + text)
        call([PROGRAMS / "contact-dd-partition", folder / "scene.toml", "-o", folder / "scene.h5"])
        report = folder / "report.json"
        call([PROGRAMS / "contact-dd-mpi", folder / "scene.h5", "--report", report, "--quiet"])
        found = json.loads(report.read_text())
    steps = found["steps"] or [found]
    return {(k, one["name"]): one for k, step in enumerate(steps) for one in step["quantities"]}


def comparisons(scene, kind):
    """Of each quantity on each mesh: its name, the true error, the estimate, the bar."""
    near, truth = (solved(scene, kind, fine) for fine in FINEST[kind])
    for fine in MESHES:
        for key, one in solved(scene, kind, fine).items():
            exact = truth[key]["value"]
            error, own = one["value"] - exact, abs(near[key]["value"] - exact)
            if one["error_bar"] and abs(error) > LEAST * abs(exact) and own < UNCERTAIN * abs(error):
                yield f"{key[1]}, {kind}, {fine}", error, one["error"], one["error_bar"]


def row(words, found):
    bars = sorted(abs(error) / bar for _, error, _, bar in found)
    signed = [error / told for _, error, told, bar in found if abs(told) >= 0.5 * bar]
    right = sum(share > 0 for share in signed)
    inside = sum(share <= 1 for share in bars) / len(bars)
    near = sum(share <= 1.5 for share in bars) / len(bars)
    cells = [words, len(bars), f"{inside:.0%}", f"{near:.0%}", f"{bars[len(bars) // 2]:.2f}", f"{bars[-1]:.1f}"]
    return "| " + " | ".join(map(str, [*cells, f"{right} of {len(signed)}"])) + " |"


def main():
    everything = []
    print(
        f"{measured()}:\n\n| scenes | errors | within the bar | within 1.5 bars | median, in bars | farthest | right signs, of those "
        "told |\n|---|--:|--:|--:|--:|--:|--:|"
    )
    for words, scenes in SCENES.items():
        found = []
        for name, scene in scenes.items():
            if name not in (sys.argv[1:] or [name]):
                continue
            for kind in FINEST:
                for of, error, told, bar in comparisons(scene, kind):
                    found.append((of, error, told, bar))
                    say(f"{name:22} {of:26} {error:+.2e} told {told:+.2e} ± {bar:.2e}: {error / bar:+.2f} bars")
        if found:
            print(row(words, found), flush=True)
        everything += found
    print(row("all", everything))


if __name__ == "__main__":
    main()
