"""Tables of decks, as CalculiX prints them."""

import re

import numpy as np
import pytest
from conftest import ROOT

from contact_dd.command import main
from contact_dd.dat import time_of

HEXAHEDRON = """1, 0, 0, 0
2, 2, 0, 0.1
3, 2.1, 1, 0
4, 0, 1.2, 0
5, 0.1, 0, 1
6, 1.9, 0.1, 1
7, 2, 1, 1.1
8, 0, 1, 1
"""
SQUARE = "1, 1, 0\n2, 3, 0.1\n3, 3.1, 1\n4, 1, 1.2\n"
MATERIAL = """*MATERIAL, NAME=M
*ELASTIC
210e3, 0.3
*EXPANSION
1e-5
*SOLID SECTION, ELSET=E, MATERIAL=M
"""


def decks():
    """A skew element of each kind, and which of its nodes are held, and loaded."""
    yield "C3D8I", HEXAHEDRON, "1, 2, 3, 4, 5, 6, 7, 8", [1, 4, 5, 8], 7
    yield "C3D8", HEXAHEDRON, "1, 2, 3, 4, 5, 6, 7, 8", [1, 4, 5, 8], 7
    for kind in "CPS4I", "CPE4", "CAX4":
        yield kind, SQUARE, "1, 2, 3, 4", [1, 4], 3
    middles = "5, 2, 0\n6, 3, 0.5\n7, 2, 1.15\n8, 1.05, 0.6\n"
    for kind in "CPE8", "CPS8R", "CAX8":
        yield kind, SQUARE + middles, "1, 2, 3, 4, 5, 6, 7, 8", [1, 8, 4], 3
    yield "CPE6", "1, 0, 0\n2, 2, 0\n3, 0, 1\n4, 1, 0.1\n5, 1, 0.5\n6, 0, 0.5\n", "1, 2, 3, 4, 5, 6", [1, 6, 3], 2
    corners = [(0, 0, 0), (2, 0, 0), (0, 1, 0), (0, 0, 1)]
    edges = [(0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)]
    places = [*corners, *(tuple((np.array(corners[a]) + corners[b]) / 2) for a, b in edges)]
    nodes = "".join(f"{k}, {x}, {y}, {z}\n" for k, (x, y, z) in enumerate(places, start=1))
    yield "C3D10", nodes, "1, 2, 3, 4, 5, 6, 7, 8, 9, 10", [1, 3, 4, 7, 8, 10], 2


def printed(path):
    """The tables of a file, by the words before their time."""
    tables = {}
    for line in path.read_text().splitlines():
        head = re.match(r" ([a-z].*) for set (\w+) and time (.*)", line)
        if head:
            rows = tables.setdefault((head[1].split(" (")[0], head[2], float(head[3])), [])
        elif tables and "E" in line and "S T E P" not in line and "INCREMENT" not in line:
            rows.append([float(word) for word in line.split()])
    return {key: np.array(rows) for key, rows in tables.items()}


def run(monkeypatch, *arguments):
    monkeypatch.setattr("sys.argv", ["contact-dd", *map(str, arguments)])
    main()


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("part", list(decks()), ids=lambda part: part[0])
def test_forces_are_loads_and_reactions(part, tmp_path, monkeypatch):
    kind, nodes, element, held, loaded = part
    deck = tmp_path / "part.inp"
    rows = "".join(f"{node}, 1, {3 if kind.startswith('C3D') else 2}\n" for node in held)
    deck.write_text(
        f"*NODE, NSET=N\n{nodes}*ELEMENT, TYPE={kind}, ELSET=E\n1, {element}\n{MATERIAL}*BOUNDARY\n{rows}"
        "*INITIAL CONDITIONS, TYPE=TEMPERATURE\nN, 20.\n*STEP\n*STATIC\n*TEMPERATURE\nN, 60.\n"
        f"*CLOAD\n{loaded}, 1, 3e3\n{loaded}, 2, -2e3\n*NODE PRINT, NSET=N, TOTALS=YES\nU, RF\n*EL PRINT, ELSET=E\nS\n"
        "*END STEP\n"
    )
    run(monkeypatch, "run", deck, "--ranks", 1, "--folder", tmp_path)
    tables = printed(tmp_path / "part.dat")
    forces = {int(row[0]): row[1:] for row in tables["forces", "N", 1.0]}
    scale = max(abs(force).max() for force in forces.values())
    for node, force in forces.items():
        if node not in held:
            expected = [3e3, -2e3, 0.0] if node == loaded else np.zeros(3)
            np.testing.assert_allclose(force, expected, atol=1e-6 * scale)
    total = tables["total force", "N", 1.0][0]
    np.testing.assert_allclose(total[1:], [0, 0], atol=1e-5 * scale)
    points = {"C3D8I": 8, "C3D8": 8, "C3D10": 4, "CPE6": 9, "CPE8": 27, "CAX8": 27, "CPS8R": 8}.get(kind, 8)
    assert [int(row[1]) for row in tables["stresses", "E", 1.0]] == list(range(1, points + 1))


def test_a_deck_of_the_pages_is_printed(tmp_path, monkeypatch):
    text = (ROOT / "docs/decks.md").read_text().split("```inp\n")[1].split("```")[0]
    wanted = "*NODE PRINT, NSET=BOTTOM, TOTALS=ONLY\nRF\n*NODE PRINT, NSET=TOP\nU\n*EL PRINT, ELSET=UPPER\nS, E, EVOL\n"
    first, rest = text.split("*END STEP\n", 1)
    deck = tmp_path / "part.inp"
    deck.write_text(f"{first}{wanted}*END STEP\n{rest}")
    run(monkeypatch, "run", deck, "--folder", tmp_path)
    lines = (tmp_path / "part.dat").read_text().splitlines()
    assert lines[:9] == [
        "", f"{' ' * 24}S T E P       1", "", "", f"{' ' * 32}INCREMENT     1", "", "",
        " total force (fx,fy,fz) for set BOTTOM and time  0.1000000E+01", "",
    ]
    tables = printed(tmp_path / "part.dat")
    # A pressure of 10 on 1, then four forces of 0.4 along x beside it.
    for time, along in (1.0, 0.0), (2.0, -1.6):
        np.testing.assert_allclose(tables["total force", "BOTTOM", time][0], [along, 0, 10], atol=1e-5)
        stress = tables["stresses", "UPPER", time]
        assert stress[:, 0].tolist() == [2] * 8
        np.testing.assert_allclose(stress[:, 4].mean(), -10, rtol=1e-6)
        np.testing.assert_allclose(tables["volume", "UPPER", time], [[2, 1]])
    strain, stress = tables["strains", "UPPER", 1.0], tables["stresses", "UPPER", 1.0]
    trace = stress[:, 2:5].sum(axis=1)
    np.testing.assert_allclose(strain[:, 4], (1.3 * stress[:, 4] - 0.3 * trace) / 210e3, rtol=1e-5)
    assert len(tables["displacements", "TOP", 2.0]) == 4


@pytest.mark.filterwarnings("ignore")
def test_a_reference_node_has_its_motion_and_its_force(tmp_path, monkeypatch):
    deck = tmp_path / "part.inp"
    deck.write_text(
        f"*NODE, NSET=N\n{HEXAHEDRON}20, 0.5, 0.5, 3\n30, 1, 1, 1\n"
        "*ELEMENT, TYPE=C3D8, ELSET=E\n1, 1, 2, 3, 4, 5, 6, 7, 8\n"
        f"{MATERIAL}*SURFACE, NAME=ROOF\nE, S2\n*COUPLING, CONSTRAINT NAME=C, REF NODE=20, SURFACE=ROOF\n*KINEMATIC\n"
        "*BOUNDARY\n1, 1, 3\n2, 1, 3\n3, 1, 3\n4, 1, 3\n20, 3, 3, 1e-3\n20, 4, 6\n*NSET, NSET=R\n20\n*STEP\n*STATIC\n"
        "*CLOAD\n20, 1, 2e3\n*NODE PRINT, NSET=R\nU, RF\n*NODE PRINT, NSET=N, TOTALS=ONLY\nRF\n*NODE PRINT, NSET=N\nU\n"
        "*END STEP\n"
    )
    run(monkeypatch, "run", deck, "--ranks", 1, "--folder", tmp_path)
    tables = printed(tmp_path / "part.dat")
    motion, force = tables["displacements", "R", 1.0][0, 1:], tables["forces", "R", 1.0][0, 1:]
    roof = tables["displacements", "N", 1.0]
    np.testing.assert_allclose(motion[2], 1e-3, rtol=1e-6)
    for row in roof[4:8]:
        np.testing.assert_allclose(row[1:], motion, rtol=1e-5, atol=1e-12)
    np.testing.assert_allclose(force[:2], [2e3, 0.0], atol=1.0)
    # What holds the foot balances it.
    np.testing.assert_allclose(tables["total force", "N", 1.0][0], 0.0, atol=1e-4 * abs(force[2]))


@pytest.mark.filterwarnings("ignore")
def test_supports_of_some_steps_have_their_reactions(tmp_path, monkeypatch):
    deck = tmp_path / "part.inp"
    foot = "1, 1, 3\n2, 1, 3\n3, 1, 3\n4, 1, 3\n"
    deck.write_text(
        f"*NODE, NSET=N\n{HEXAHEDRON}20, 0.5, 0.5, 3\n"
        "*ELEMENT, TYPE=C3D8, ELSET=E\n1, 1, 2, 3, 4, 5, 6, 7, 8\n"
        f"{MATERIAL}*SURFACE, NAME=ROOF\nE, S2\n*COUPLING, CONSTRAINT NAME=C, REF NODE=20, SURFACE=ROOF\n*KINEMATIC\n"
        f"*BOUNDARY\n{foot}*NSET, NSET=R\n20\n*STEP\n*STATIC\n*BOUNDARY\n20, 3, 3, 1e-3\n*CLOAD\n20, 1, 2e3\n"
        "*NODE PRINT, NSET=R\nRF\n*NODE PRINT, NSET=N, TOTALS=ONLY\nRF\n*END STEP\n"
        f"*STEP\n*STATIC\n*BOUNDARY, OP=NEW\n{foot}*END STEP\n"
    )
    run(monkeypatch, "run", deck, "--ranks", 1, "--folder", tmp_path)
    tables = printed(tmp_path / "part.dat")
    held, free = (tables["forces", "R", time][0, 1:] for time in (1.0, 2.0))
    assert abs(held[2]) > 100
    np.testing.assert_allclose(held[:2], [2e3, 0.0], atol=0.1)
    np.testing.assert_allclose(free, [2e3, 0.0, 0.0], atol=0.1)
    for time in (1.0, 2.0):
        np.testing.assert_allclose(tables["total force", "N", time][0], 0.0, atol=0.1)


@pytest.mark.filterwarnings("ignore")
def test_a_bolt_has_its_shortening_and_its_force(tmp_path, monkeypatch):
    corners = [(0, 0), (1, 0), (1, 1), (0, 1)]
    nodes = "".join(f"{4 * z + k}, {x}, {y}, {z}\n" for z in range(3) for k, (x, y) in enumerate(corners, start=1))
    walls = "1, 1, 3\n2, 1, 3\n3, 1, 3\n4, 1, 3\n9, 1, 2\n10, 1, 2\n11, 1, 2\n12, 1, 2\n"
    lift = "*BOUNDARY\n" + "".join(f"{node}, 3, 3, {{0}}\n" for node in range(9, 13))
    for surface, sense in ("1, S2", 1), ("2, S1", -1):
        deck = tmp_path / "part.inp"
        deck.write_text(
            f"*NODE\n{nodes}99, 0, 0, 0\n*ELEMENT, TYPE=C3D8, ELSET=E\n1, 1, 2, 3, 4, 5, 6, 7, 8\n"
            "2, 5, 6, 7, 8, 9, 10, 11, 12\n*NSET, NSET=P\n99\n*NSET, NSET=CUT\n5, 6, 7, 8\n"
            f"*SURFACE, NAME=S\n{surface}\n"
            "*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.\n*SOLID SECTION, ELSET=E, MATERIAL=M\n"
            f"*PRE-TENSION SECTION, SURFACE=S, NODE=99\n0., 0., 1.\n*BOUNDARY\n{walls}{lift.format('0.')}"
            f"*STEP\n*STATIC\n*CLOAD\n99, 1, {20 * sense}.\n*NODE PRINT, NSET=P\nU, RF\n*NODE PRINT, NSET=CUT\nU\n"
            "*END STEP\n"
            f"*STEP\n*STATIC\n*BOUNDARY, FIXED\n99, 1\n{lift.format('0.01')}*END STEP\n"
        )
        run(monkeypatch, "run", deck, "--ranks", 1, "--folder", tmp_path)
        tables = printed(tmp_path / "part.dat")
        # E A / L = 500 of the whole bar.
        for time, force in (1.0, 20.0), (2.0, 25.0):
            np.testing.assert_allclose(tables["displacements", "P", time], [[99, 0.04 * sense, 0, 0]], rtol=1e-5)
            np.testing.assert_allclose(tables["forces", "P", time], [[99, force * sense, 0, 0]], rtol=1e-5)
        np.testing.assert_allclose(tables["displacements", "CUT", 1.0][:, 3], -0.02 * sense, rtol=1e-5)


def test_times_are_those_of_fortran():
    assert [time_of(time) for time in (0.0, 1.0, 12.5, 0.05)] == [
        " 0.0000000E+00", " 0.1000000E+01", " 0.1250000E+02", " 0.5000000E-01"
    ]
