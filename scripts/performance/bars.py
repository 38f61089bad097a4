"""Checks the error bars of `compare` against much better meshes; run it by scripts/bars, whose table is on
docs/report.md."""

import pathlib
import sys
import warnings

import gmsh

root = pathlib.Path(__file__).resolve().parents[2]
sys.path[:0] = [str(root / "python"), str(root / "python/tests")]

from contact_dd import InputError, NotConverged, adapt, compare
from contact_dd.comparison import numbers_of
from edges import SCENES, on_meshes, outside

# The estimated error of the meshes that stand for the truth, in the energy norm.
BEST = 1e-3
KINDS = [("tri", 1), ("quad", 1), ("tri", 2), ("quad", 2)]


def truth_of(scene, size):
    """The numbers of a scene on a mesh of quadratic cells that has adapted."""
    try:
        model = scene(size, ("tri", 2))
        try:
            result, _ = adapt(model, BEST, ranks=1, progress=False)
        except NotConverged as late:
            result = late.result
    finally:
        gmsh.finalize()
    return {name: value for (_, name, _), value in numbers_of(result)}


def kind_of(name):
    return "pressures" if name.startswith("largest pressure") else "work" if name.startswith("work") else "forces"


def main():
    warnings.simplefilter("ignore")
    chosen = {scene: size for scene, size in SCENES.items() if scene.__name__ in (sys.argv[1:] or [scene.__name__])}
    counts = {}
    for scene, size in chosen.items():
        truth = truth_of(scene, size)
        for cells, order in KINDS:
            results = on_meshes(scene, (cells, order), [size / 2**k for k in range(4)])
            for meshes in (2, 3):
                for first in range(5 - meshes):
                    try:
                        found = compare(results[first : first + meshes])
                    except InputError:
                        continue
                    off, _ = outside(found, truth)
                    for one in found:
                        count = counts.setdefault((order, meshes, kind_of(one.name)), [0, 0, 0, 0.0])
                        count[0] += 1
                        count[1] += one.error is not None
                        count[2] += one.name in off
                        count[3] = max(count[3], off.get(one.name, 0.0))
                    for name, bars in off.items():
                        print(f"{scene.__name__} {cells} {order}, {meshes} meshes from {first}: {name}: {bars:.2g} bars",
                              file=sys.stderr)
    print("| cells | meshes | | numbers | with a bar | exact value inside | farthest, in bars |\n|---|--:|---|--:|--:|--:|--:|")
    for (order, meshes, kind), (every, barred, off, most) in sorted(counts.items()):
        name = "linear" if order == 1 else "quadratic"
        held = f"{(barred - off) / barred:.0%}" if barred else ""
        print(f"| {name} | {meshes} | {kind} | {every} | {barred} | {held} | {f'{most:.1f}' if most else ''} |")


main()
