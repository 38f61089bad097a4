"""Runs decks of CalculiX and compares the results with its own.

usage: PYTHONPATH=python python3 studies/calculix.py FOLDER [NAME …]

FOLDER holds decks, NAME.inp, with the results of CalculiX, NAME.dat.ref and NAME.frd.ref, as the folder test of
github.com/Dhondtguido/CalculiX does. Where ccx is on the path, each deck is given to it once more without NLGEOM, as
it is computed here. Printed are the largest differences of displacements over the largest one, those of what decks
print beside them (forces, stresses, strains), and why decks are refused; at the end for each class of decks how many
run and agree in displacements, or where there are none in the rest. Needs h5py, and both programs in CONTACT_DD_BIN
or on the path."""

import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

import h5py
import numpy as np
from contact_dd.dat import write_dat
from contact_dd.result import Result

TABLE = re.compile(r"\s*(total force|forces|stresses|strains) \(.*for set (\S+) and time\s+(\S+)")
TITLE = re.compile(r"\s*displacements \(vx,vy,vz\) for set (\S+) and time\s+(\S+)")
# Keywords, without blanks, of what isn't static, elastic, small or of solids, or needs the results of another deck.
OTHERS = set("""PLASTIC CREEP HYPERELASTIC HYPERFOAM CYCLICHARDENING DEFORMATIONPLASTICITY USERMATERIAL MOHRCOULOMB
RATEDEPENDENT VISCO DYNAMIC MODALDYNAMIC STEADYSTATEDYNAMICS FREQUENCY COMPLEXFREQUENCY BUCKLE CFD ELECTROMAGNETICS
SENSITIVITY GREEN SUBSTRUCTUREGENERATE COUPLEDTEMPERATURE-DISPLACEMENT UNCOUPLEDTEMPERATURE-DISPLACEMENT HEATTRANSFER
CRACKPROPAGATION FEASIBLEDIRECTION ROBUSTDESIGN REFINEMESH MATRIXASSEMBLE SHELLSECTION BEAMSECTION BEAMGENERALSECTION
MEMBRANESECTION FLUIDSECTION MASS DASHPOT USERELEMENT GAP FRAMESECTION TRUSSSECTION MEMBRANE SUBMODEL""".split())
# Elements that are none of solids, and temperatures that another deck computes.
NOT_SOLID = re.compile(r"(?m)^\*ELEMENT\b.*TYPE *= *([ST]\d|M3D|B3|PIPE)|^\*TEMPERATURE.*FILE")
NEEDED = {"STATIC", "SOLIDSECTION"}
CONTACT, LINEAR, LARGE, OTHER = "with contact", "linear, without", "NLGEOM, without", "others"


def main() -> None:
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    folder = Path(sys.argv[1])
    names = sys.argv[2:] or sorted(path.stem for path in folder.glob("*.inp"))
    found: dict[str, list[float | None]] = {CONTACT: [], LINEAR: [], LARGE: [], OTHER: []}
    print(f"{'deck':24} {'class':16} {'reference':>10} {'as here':>10} {'tables':>10}")
    for name in names:
        deck = folder / f"{name}.inp"
        of_class = class_of(deck)
        with tempfile.TemporaryDirectory() as place:
            said, result = solved(deck, Path(place))
            if result is None:
                found[of_class].append(None)
                print(f"{name:24} {of_class:16} {said}", flush=True)
                continue
            again = as_here(deck, Path(place))
            there = displacements(folder / f"{name}.dat.ref") + of_frd(folder / f"{name}.frd.ref")
            here = displacements(again) + of_frd(again.with_suffix(".frd"))
            own = result.with_name("own.dat")
            numbers = nodes(deck)
            apart = [difference(result, part, numbers) for part in (there, here)]
            apart.append(of_tables(own, folder / f"{name}.dat.ref"))
            found[of_class].append(apart[2] if np.isnan(apart[0]) else apart[0])
            print(f"{name:24} {of_class:16} " + " ".join(f"{each:10.1e}" for each in apart), flush=True)
    for of_class, all_apart in found.items():
        ran = [each for each in all_apart if each is not None]
        counts = ", ".join(f"{sum(each <= most for each in ran)} within {most:g}" for most in (1e-4, 2e-3, 1e-2))
        unknown = sum(np.isnan(each) for each in ran)
        print(f"{of_class:16} {len(ran)} of {len(all_apart)} run, {counts}, {unknown} with nothing to compare")


def class_of(deck: Path) -> str:
    text = deck.read_text(errors="replace").upper()
    keywords = {line[1:].split(",")[0].replace(" ", "") for line in text.splitlines() if re.match(r"\*[^*]", line)}
    if not NEEDED <= keywords or keywords & OTHERS or NOT_SOLID.search(text):
        return OTHER
    if "CONTACTPAIR" in keywords:
        return CONTACT
    return LARGE if re.search(r"(?m)^\*STEP.*NLGEOM", text) else LINEAR


def solved(deck: Path, place: Path) -> tuple[str, Path | None]:
    """What the programs say of a deck that they don't solve, or the result, with its tables in own.dat beside it."""
    problem, result, prints = place / "problem.h5", place / "problem.vtkhdf", place / "prints.json"
    of_deck: list[str | Path] = ["contact-dd-partition", deck, "-o", problem, "--write-prints", prints]
    path = os.pathsep.join((os.environ.get("CONTACT_DD_BIN", ""), os.environ["PATH"]))
    for command in (of_deck, ["contact-dd-mpi", problem, "-o", result]):
        program = shutil.which(command[0], path=path) or command[0]
        ended = subprocess.run([program, *command[1:]], capture_output=True, text=True)
        if ended.returncode:
            words = (ended.stderr.strip().splitlines() or ["no word"])[0]
            return f"{ended.returncode}: {words.removeprefix('error: ').removeprefix(f'{deck}: ')}", None
    write_dat(Result(result), json.loads(prints.read_text()), place / "own.dat")
    return "", result


def as_here(deck: Path, place: Path) -> Path:
    """CalculiX' results of the deck as it is computed here."""
    text = deck.read_text(errors="replace")
    text = re.sub(r"(?i)\bC3D8R\b", "C3D8", text)
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


def of_frd(path: Path) -> list[tuple[float, dict[int, np.ndarray]]]:
    """Displacements in a file of results."""
    blocks: list[tuple[float, dict[int, np.ndarray]]] = []
    of_block: dict[int, np.ndarray] | None = None
    time = 0.0
    for line in path.read_text(errors="replace").splitlines() if path.exists() else ():
        if line.startswith("  100C"):
            time = float(line[12:24])
        elif line.startswith((" -4", " -3")):
            of_block = {} if line.startswith(" -4  DISP ") else None
            if of_block is not None:
                blocks.append((time, of_block))
        elif line.startswith(" -1") and of_block is not None:
            of_block[int(line[3:13])] = np.array([float(line[place:place + 12]) for place in (13, 25, 37)])
    return blocks


def tables(path: Path) -> dict[tuple[str, str, float, int, tuple[str, ...]], np.ndarray]:
    """Rows of forces, stresses and strains, by table, set, time, how often it came before, and number."""
    rows = {}
    title: tuple[str, str, float, int] | None = None
    seen: list[tuple[str, str, float]] = []
    for line in path.read_text().splitlines() if path.exists() else ():
        words = line.split()
        if found := TABLE.match(line):
            own = (found[1], found[2].upper(), float(found[3]))
            title = (*own, seen.count(own))
            seen.append(own)
        elif title and words:
            numbers = [word for word in words if word.isdigit()]
            try:
                rows[*title, tuple(numbers)] = np.array([float(word) for word in words[len(numbers):]])
            except ValueError:
                title = None
    return rows


def of_tables(here: Path, there: Path) -> float:
    """The largest difference of rows of a kind over the largest value of that kind; NaN where there are none."""
    own, expected = tables(here), tables(there)
    worst = np.nan
    for kind in {key[0] for key in own.keys() & expected.keys()}:
        both = [(own[key], expected[key]) for key in own.keys() & expected.keys() if key[0] == kind]
        both = [(a, b) for a, b in both if len(a) == len(b)]
        largest = max((np.abs(b).max() for _, b in both), default=0.0)
        if largest:
            worst = np.fmax(worst, max(np.abs(a - b).max() for a, b in both) / largest)
    return worst


def nodes(deck: Path) -> set[int]:
    """The numbers of the nodes of a deck: cuts of pretensions have others, which differ, and nodes that are none."""
    text = deck.read_text(errors="replace")
    blocks = re.findall(r"(?im)^\*NODE *(?:,.*)?\n((?:(?!\*[^*]).*\n)*)", text)
    bolts = re.findall(r"(?im)^\*PRE-TENSION SECTION.*NODE *= *(\d+)", text)
    return {int(number) for block in blocks for number in re.findall(r"(?m)^\s*(\d+)\s*,", block)} - {*map(int, bolts)}


def difference(result: Path, there: list[tuple[float, dict[int, np.ndarray]]], numbers: set[int]) -> float:
    """The largest difference over the largest displacement at the ends of steps; NaN where there are none."""
    worst, largest = 0.0, 0.0
    whole = Result(result)
    with h5py.File(result) as file:
        times = file["VTKHDF/Steps/Values"][:] if "Steps" in file["VTKHDF"] else np.array([1.0])
    # Nodes of couplings' frames have other numbers than the deck's reference nodes.
    rows = np.unique(np.concatenate([cells.nodes.ravel() for cells in whole.cells]))
    tags = whole.nodes[rows].tolist()
    for time, expected in there:
        for step in np.flatnonzero(np.isclose(times, time))[:1]:
            at = whole.at_step(int(step) + 1) if len(times) > 1 else whole
            own = dict(zip(tags, at.displacement[rows]))
            for tag in own.keys() & expected.keys() & (numbers or own.keys()):
                worst = max(worst, np.abs(own[tag] - expected[tag]).max())
                largest = max(largest, np.abs(expected[tag]).max())
    return worst / largest if largest else np.nan


main()
