"""Tables that a deck prints of a step of a result: values at nodes, and at CalculiX' points of elements."""

from __future__ import annotations

from collections.abc import Iterator
from functools import cached_property
from typing import Any

import h5py
import numpy as np
from numpy.typing import NDArray

from contact_dd.cells import Cells
from contact_dd.drawing.conditions import Problem, candidates
from contact_dd.errors import InputError
from contact_dd.result import Result
from contact_dd.strains import (
    HEXAHEDRA,
    LINEAR,
    QUADRILATERALS,
    TETRAHEDRA,
    WITH_MODES,
    Floats,
    Strained,
    amplitudes,
    grid,
    orbit,
    rule,
)

Rows = tuple[list[int], list[int | None], Floats]

# XX YY ZZ XY XZ YZ by their places in strains of three, four and six components.
IN_PLANE, AROUND, IN_SPACE = (0, 1, None, 2), (0, 1, 2, 3), (0, 1, 2, 5, 4, 3)
# The same of stresses of results, XX YY ZZ XY YZ XZ.
OF_STRESS = [0, 1, 2, 3, 5, 4]


class Printed:
    """A step of a result. Raises `InputError` where there is no problem file of it."""

    def __init__(self, result: Result, prints: dict[str, Any]) -> None:
        self.result, self.prints = result, prints
        self.dimension = 3 if result.is_in_space else 2
        self.is_around_axis = result.plane == "axisymmetric"
        steps = result.report.get("steps") or []
        found = candidates(result)
        if not found:
            raise InputError(f"{result.path}: its problem file isn't beside it; expected it for what a deck prints")
        with h5py.File(found[0]) as file:
            self.problem = Problem(result, file)
            self.time = float(file["steps/time"][result.step - 1]) if steps else 1.0
            self.stiffness = file["materials/stiffness"][:]
            self.out_of_plane = file["materials/out_of_plane"][:] if "out_of_plane" in file["materials"] else None
            self.poisson = file["materials/poisson"][:] if "poisson" in file["materials"] else None
            self.has_modes, self.is_reduced = (
                np.zeros(len(self.stiffness), dtype=bool) if found is None else found[:] == 1
                for found in map(file["materials"].get, ("incompatible_modes", "reduced_integration"))
            )
            # In a deck it is the same everywhere in a cell.
            self.initial = self.problem.mean_stress()
            self.external = self._held(file)

    @staticmethod
    def left_out(prints: dict[str, Any], plane: str | None) -> list[str]:
        """Tables that aren't printed, in words."""
        labels = {table["label"] for tables in prints["steps"] for table in tables}
        without = WITHOUT.get(plane, {})
        return [f"{label} of *EL PRINT isn't printed in {without[label]}" for label in sorted(labels & without.keys())]

    @property
    def without(self) -> set[str]:
        """The labels that aren't printed."""
        return set(WITHOUT.get(self.result.plane, {}))

    def rows(self, label: str, name: str) -> Rows:
        """Numbers, points of integration and values of a set."""
        if label in ("U", "RF"):
            return self._of_nodes(label, self.prints["nodes"][name])
        return self._of_elements(label, self.prints["elements"][name])

    def _of_nodes(self, label: str, numbers: list[int]) -> Rows:
        values = self.result.displacement if label == "U" else self.forces * self.prints["thickness"]
        rows = np.searchsorted(self.result.nodes, numbers).clip(max=len(self.result.nodes) - 1)
        is_there = (self.result.nodes[rows] == numbers) & self.problem.is_there[rows]
        found = {number: values[row] for number, row, there in zip(numbers, rows, is_there, strict=True) if there}
        for number in set(numbers) & self._frames.keys():
            frame = values[self._frames[number]]
            found[number] = frame[0] if label == "U" else frame.sum(axis=0)
        found.update({number: values for number, values in self._bolts(label).items() if number in numbers})
        numbers = [number for number in numbers if number in found]
        return numbers, [None] * len(numbers), np.array([found[number] for number in numbers]).reshape(-1, 3)

    def _bolts(self, label: str) -> dict[int, Floats]:
        """The shortening or the force of pretensions by their nodes, along the first axis."""
        report = self.result.report
        steps = report.get("steps") or [report]
        of_step = {bolt["name"]: bolt for bolt in steps[self.result.step - 1]["pretensions"]}
        key, unit = ("shortening", 1.0) if label == "U" else ("force", self.prints["thickness"])
        bolts = self.prints.get("bolts", {}).items()
        return {int(number): np.array([sense * unit * of_step[name][key], 0, 0]) for number, (name, sense) in bolts}

    @cached_property
    def _frames(self) -> dict[int, NDArray[np.intp]]:
        """The rows of the nodes that stand for a reference node, the first of them in its place."""
        of_cells = np.concatenate([cells.nodes.ravel() for cells in self.result.cells])
        others = np.setdiff1d(np.arange(len(self.result.nodes)), of_cells)
        references = self.prints.get("references", [])
        return dict(zip(references, np.array_split(others, len(references)), strict=True)) if references else {}

    def _of_elements(self, label: str, numbers: list[int]) -> Rows:
        tags: list[int] = []
        points: list[int | None] = []
        values = []
        parts: dict[tuple[int, bool], list[int]] = {}
        for number in numbers:
            if number in self._places:
                part, _ = self._places[number]
                parts.setdefault((part, self.prints["cells"][str(number)]["is_reduced"]), []).append(number)
        for (part, is_reduced), members in parts.items():
            places = [self._places[number][1] for number in members]
            found = self._values(label, self._cells(part, places), is_reduced)
            tags += [number for number in members for _ in range(found.shape[1])]
            points += [None if label == "EVOL" else k + 1 for _ in members for k in range(found.shape[1])]
            values.append(found.reshape(-1, found.shape[2]))
        order = sorted(range(len(tags)), key=lambda k: (tags[k], points[k] or 0))
        all_values = np.concatenate(values) if values else np.zeros((0, 1 if label == "EVOL" else 6))
        return [tags[k] for k in order], [points[k] for k in order], all_values[order]

    @cached_property
    def _places(self) -> dict[int, tuple[int, int]]:
        """The kind of the printed elements and their places in it, by number, found by the positions of nodes."""
        same = np.unique(self.result.points, axis=0, return_inverse=True)[1].ravel()
        found = {}
        for part, cells in enumerate(self.result.cells):
            keys = np.sort(same[cells.nodes], axis=1)
            found.update({key.tobytes(): (part, place) for place, key in enumerate(keys)})
        places = {}
        for number, cell in self.prints["cells"].items():
            rows = np.searchsorted(self.result.nodes, cell["nodes"]).clip(max=len(self.result.nodes) - 1)
            place = found.get(np.sort(same[rows]).tobytes())
            if place is not None:
                places[int(number)] = place
        return places

    def _cells(self, part: int, places: list[int]) -> Cells:
        cells = self.result.cells[part]
        return Cells(cells.kind, cells.members[places], cells.nodes[places])

    def _strained(self, cells: Cells, at: Floats, weights: Floats) -> tuple[Strained, Floats]:
        """Cells at points, with strains there."""
        corners = self.result.points[cells.nodes][..., : self.dimension]
        u = self.result.displacement[cells.nodes][..., : self.dimension].reshape(len(cells.nodes), -1)
        strained = Strained(cells.kind, corners, at, weights, self.is_around_axis)
        strain: Floats = np.einsum("cqvm,cm->cqv", strained.operator, u)
        material = self.result.cell_data["Material"][cells.members]
        bends = self.has_modes[material]
        if cells.kind in WITH_MODES and bends.any() and not self.is_around_axis:
            at_rule = Strained(cells.kind, corners[bends], *rule(cells.kind))
            of_modes = amplitudes(at_rule, self.stiffness[material[bends]], u[bends])
            strain[bends] += np.einsum("cqvm,cm->cqv", strained.modes[bends], of_modes)
        return strained, strain

    def _stress(self, cells: Cells, strain: Floats) -> Floats:
        """Stresses, XX YY ZZ XY XZ YZ."""
        material = self.result.cell_data["Material"][cells.members]
        voigt = np.einsum("cvw,cqw->cqv", self.stiffness[material], strain)
        stress = components(voigt, 1.0)
        if self.result.plane == "strain" and self.out_of_plane is not None:
            stress[..., 2] = np.einsum("cw,cqw->cq", self.out_of_plane[material], strain)
        if self.initial is not None:
            stress += self.initial[cells.members][:, None, OF_STRESS]
        return stress

    def _values(self, label: str, cells: Cells, is_reduced: bool) -> Floats:
        """Values of cells, (cells, points, components)."""
        if label == "EVOL":
            strained, _ = self._strained(cells, *rule(cells.kind, self.is_around_axis, is_reduced))
            volume: Floats = strained.volume.sum(axis=1)[:, None, None] * self.prints["thickness"]
            return volume
        at, layers = points_of(cells.kind, is_reduced)
        _, strain = self._strained(cells, at, np.ones(len(at)))
        values = self._stress(cells, strain) if label == "S" else components(strain, 0.5)
        return np.tile(values, (1, layers, 1))

    def _by_rule(self) -> Iterator[tuple[Cells, bool]]:
        """The cells by kind and rule of integration."""
        for part, cells in enumerate(self.result.cells):
            is_reduced = self.is_reduced[self.result.cell_data["Material"][cells.members]]
            for which in (False, True):
                if len(places := np.flatnonzero(is_reduced == which)):
                    yield self._cells(part, places.tolist()), which

    @cached_property
    def forces(self) -> Floats:
        """External forces on nodes, loads and reactions: the balance of stresses, contacts, ties and springs."""
        total = self.external.copy()
        for cells, is_reduced in self._by_rule():
            at, weights = rule(cells.kind, self.is_around_axis, is_reduced)
            strained, strain = self._strained(cells, at, weights)
            stress = self._stress(cells, strain)
            order = {3: [0, 1, 3], 4: [0, 1, 2, 3], 6: [0, 1, 2, 5, 4, 3]}[strain.shape[2]]
            force = np.einsum("cq,cqvm,cqv->cm", strained.volume, strained.operator, stress[..., order])
            one = self.problem.one[cells.nodes]
            np.add.at(total[:, : self.dimension], one, force.reshape(*one.shape, self.dimension))
        return total

    def _held(self, file: h5py.File) -> Floats:
        """Forces of contacts, ties, equations and springs on nodes."""
        total = np.zeros((len(self.result.nodes), 3))
        first, row, dimension = self.problem.first, self.problem.row, self.dimension
        if "contact" in file:
            group = file["contact"]
            names = [name.decode() if isinstance(name, bytes) else name for name in group["name"][:]]
            owner, place = group["contact"][:], group["place"][:]
            force, along = np.zeros((len(owner), 3)), np.zeros(len(owner))
            for number, name in enumerate(names):
                table, own = self.result.contacts[name], owner == number
                if name in self.prints.get("supports", []):
                    continue
                of_point = table[place[own]]
                along[own] = of_point["force"]
                force[own, :dimension] = of_point["force"][:, None] * group["normal"][:][own]
                if "tangential_force" in (table.dtype.names or ()):
                    force[own] -= of_point["tangential_force"]
            point = np.repeat(np.arange(len(owner)), np.diff(group["entry_offset"][:]))
            nodes = row[first[group["entry_subdomain"][:]] + group["entry_node"][:]]
            of_entry = force[point]
            if "entry_axis" in group:
                axis = group["entry_axis"][:]
                own = (axis != 0).any(axis=1)
                of_entry[own] = 0.0
                of_entry[own, :dimension] = along[point[own], None] * axis[own]
            np.add.at(total, nodes, group["entry_weight"][:][:, None] * of_entry)
        if "spring" in file:
            group = file["spring"]
            start = np.repeat(first[:-1], np.diff(group["offset"][:]))
            a, b = row[group["node"][:].T + start]
            stiffness, u = group["stiffness"][:], self.result.displacement[:, :dimension]
            np.add.at(total[:, :dimension], a, np.einsum("yij,yj->yi", stiffness, u[b]))
            other = a != b
            back = np.einsum("yij,yi->yj", stiffness[other], u[a[other]])
            np.add.at(total[:, :dimension], b[other], back)
        return total


# Tables without values in plane states, with the reason.
WITHOUT: dict[str | None, dict[str, str]] = {
    "stress": {"E": "plane stress"}, "axisymmetric": {"EVOL": "cells around an axis"},
}


def components(voigt: Floats, shear: float) -> Floats:
    """XX YY ZZ XY XZ YZ of strains or stresses, those of shear times a factor."""
    places: NDArray[Any] | tuple[int | None, ...] = {3: IN_PLANE, 4: AROUND, 6: IN_SPACE}[voigt.shape[2]]
    found = np.zeros((*voigt.shape[:2], 6))
    for k, place in enumerate(places):
        if place is not None:
            found[..., k] = voigt[..., place] * (shear if k >= 3 else 1.0)
    return found


def points_of(kind: int, is_reduced: bool) -> tuple[Floats, int]:
    """The points of an element in CalculiX, and in how many layers they lie: plane elements are volumes there."""
    if kind in QUADRILATERALS + HEXAHEDRA:
        count = (2 if kind in LINEAR else 3) - is_reduced
        line = (np.polynomial.legendre.leggauss(count)[0] + 1) / 2
        return grid(line, 2 if kind in QUADRILATERALS else 3), count if kind in QUADRILATERALS else 1
    if kind in TETRAHEDRA:
        return (np.full((1, 3), 0.25), 1) if kind in LINEAR else (orbit([((5 - 5**0.5) / 20, 1.0)], 3)[0], 1)
    return (np.full((1, 2), 1 / 3), 2) if kind in LINEAR else (orbit([(1 / 6, 1.0)], 2)[0], 3)
