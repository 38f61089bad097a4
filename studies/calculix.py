"""Runs decks of CalculiX and compares displacements with its own.

usage: python3 studies/calculix.py FOLDER [NAME …]

FOLDER holds decks, NAME.inp, with the results of CalculiX, NAME.dat.ref, as the folder test of github.com/Dhondtguido/CalculiX
does. Where ccx is on the path, each deck is given to it once more as it is computed here: cells integrated in full, without
NLGEOM. Printed are the largest differences of displacements over the largest displacement, and
why decks are refused. Needs h5py, and both programs in CONTACT_DD_BIN or on the path."""

import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

import h5py
import numpy as np

TITLE = re.compile(r"\s*displacements \(vx,vy,vz\) for set (\S+) and time\s+(\S+)")


def main() -> None:
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    folder = Path(sys.argv[1])
    names = sys.argv[2:] or sorted(path.stem for path in folder.glob("*.inp"))
    refused = 0
    print(f"{'deck':24} {'reference':>10} {'as here':>10}")
    for name in names:
        with tempfile.TemporaryDirectory() as place:
            said, result = solved(folder / f"{name}.inp", Path(place))
            if result is None:
                refused += 1
                print(f"{name:24} {said}")
                continue
            there = displacements(folder / f"{name}.dat.ref")
            again = displacements(as_here(folder / f"{name}.inp", Path(place)))
            print(f"{name:24} {difference(result, there):>10} {difference(result, again):>10}", flush=True)
    print(f"{len(names) - refused} of {len(names)} decks run")


def solved(deck: Path, place: Path) -> tuple[str, Path | None]:
    """What the programs say of a deck that they don't solve, or the result."""
    problem, result = place / "problem.h5", place / "problem.vtkhdf"
    for command in (["contact-dd-partition", deck, "-o", problem], ["contact-dd-mpi", problem, "-o", result]):
        found = shutil.which(command[0], path=os.pathsep.join((os.environ.get("CONTACT_DD_BIN", ""), os.environ["PATH"])))
        ended = subprocess.run([found or command[0], *command[1:]], capture_output=True, text=True)
        if ended.returncode:
            words = (ended.stderr.strip().splitlines() or ["no word"])[0]
            return f"{ended.returncode}: {words.removeprefix('error: ').removeprefix(f'{deck}: ')}", None
    return "", result


def as_here(deck: Path, place: Path) -> Path:
    """CalculiX' results of the deck as it is computed here."""
    text = deck.read_text(errors="replace")
    text = re.sub(r"(?i)\b((?:C3D20|C3D8|CAX8|CPE8|CPS8))R\b", r"\1", text)
    text = re.sub(r"(?im)^(\*STEP.*?),\s*NLGEOM(=YES)?", r"\1", text)
    (place / "again.inp").write_text(text)
    if shutil.which("ccx"):
        subprocess.run(["ccx", "again"], cwd=place, capture_output=True, timeout=600)
    return place / "again.dat"


def displacements(path: Path) -> list[tuple[float, dict[int, np.ndarray]]]:
    """Displacements that CalculiX printed: time, and by node."""
    blocks: list[tuple[float, dict[int, np.ndarray]]] = []
    of_block: dict[int, np.ndarray] | None = None
    for line in path.read_text().splitlines() if path.exists() else ():
        words = line.split()
        if title := TITLE.match(line):
            of_block = {}
            blocks.append((float(title[2]), of_block))
        elif len(words) == 4 and words[0].isdigit() and of_block is not None:
            of_block[int(words[0])] = np.array([float(word) for word in words[1:]])
        elif words:
            of_block = None
    return blocks


def difference(result: Path, there: list[tuple[float, dict[int, np.ndarray]]]) -> str:
    """The largest difference over the largest displacement at the ends of steps."""
    worst = []
    with h5py.File(result) as file:
        grid = file["VTKHDF"]
        tags, values = grid["PointData/GlobalNodeId"][:], grid["PointData/Displacement"][:]
        times = grid["Steps/Values"][:] if "Steps" in grid else np.array([1.0])
        count = len(values) // len(times)
        for time, expected in there:
            steps = np.flatnonzero(np.isclose(times, time))
            if not len(steps):
                continue
            # Nodes of couplings' frames have other numbers than the deck's reference nodes.
            of_cells = np.unique(grid["Connectivity"][:])
            own = dict(zip(tags[of_cells].tolist(), values[steps[0] * count :][of_cells]))
            pairs = [(own[tag], value) for tag, value in expected.items() if tag in own]
            if pairs:
                apart = max(np.abs(a - b).max() for a, b in pairs)
                worst.append(apart / max(np.abs(b).max() for _, b in pairs))
    return f"{max(worst):.1e}" if worst else "-"


main()
