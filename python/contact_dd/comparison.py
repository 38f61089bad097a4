"""Error bars by comparison: the same scene on coarser and finer meshes."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from contact_dd.errors import InputError
from contact_dd.result import Result
from contact_dd.sizes import relative_errors

# Least ratio of mesh sizes from which an error follows.
LEAST_RATIO = 1.3
# Accepted orders of convergence. Below the least there may be no limit. The largest is that of forces at edges, whose
# stresses vary with the root of the distance, and of stresses in linear cells: a higher order is mostly chance, as of
# values that aren't monotonic.
ORDERS = (0.3, 1.0)
# Bars over the extrapolated error with the order observed on three meshes and without: Roache's grid convergence index.
OBSERVED, UNKNOWN = 1.25, 3.0
# The order by which a pressure at the rim of a contact grows where it has no limit.
GROWTH = 0.15
PRESSURE = "largest pressure of "
QUANTITY = "quantity "
# Differences that are no larger, relative to the largest of the kind, are round-off.
ROUND_OFF = 1e-9


@dataclass(frozen=True)
class Compared:
    """A number of a report on meshes from coarse to fine."""

    name: str
    """Name of the number: "largest pressure of left crack", "force on left crack, x"."""
    unit: str
    values: tuple[float, ...]
    """Values on the meshes, the last one on the finest."""
    error: float | None
    """Error bar of the last value, most likely; None where it doesn't converge, as at an edge that pressures
    become the higher at the finer the mesh is."""
    order: float | None
    """The order of convergence in the size of cells that three meshes show; None where they show none, 0 where
    differences don't become smaller."""


def compare(results: Sequence[Result], adapted: bool = False) -> list[Compared]:
    """Error bars of the largest pressures, forces, reactions and the work of friction in the last load step, from
    results of one scene on two or three meshes of one kind of cells. Of more results the finest one counts,
    one 1.3 times coarser, and one 1.3 times coarser again.

    With three meshes the order of convergence is observed and the error extrapolated, times 1.25; of an order above 1
    with 1, and from the difference that this leads one to expect where that is larger. With two the order is taken as
    1, and the error times 3: that is often much too large. The work of friction is known no better than energies are
    on the finest mesh, to half the square of the estimated error in their norm. Where the pressure at the rim of a
    contact grows from mesh to mesh, or is the largest and bends there, its largest has no bar; neither has what would
    have one longer than itself.

    Meshes that have `adapted` have cells of many sizes: there the estimated errors in the energy norm stand for these,
    and the last mesh is compared with one.
    """
    if len(results) < 2:
        found_of = f"the result {results[0].path} alone" if results else "no result"
        raise InputError(f"{found_of}; expected two or three results of one scene, on meshes that differ in size")

    # By the size of cells, or the estimated error in its place.
    def size(result: Result) -> float:
        if adapted:
            return relative_errors(result)[0]
        dofs: float = result.report["dofs"]
        return 1 / (math.cbrt(dofs) if result.is_in_space else math.sqrt(dofs))

    found = list[Result]()
    for result in sorted(results, key=size):
        if not found or (size(result) >= LEAST_RATIO * size(found[0]) and len(found) < (2 if adapted else 3)):
            found.insert(0, result)
    if len(found) < 2:
        if adapted:
            raise InputError(f"expected meshes with estimated errors one {LEAST_RATIO} times the other")
        dofs = ", ".join(str(result.report["dofs"]) for result in results)
        raise InputError(f"meshes with {dofs} degrees of freedom; expected cells {LEAST_RATIO} times smaller in one")
    ratios = [size(coarse) / size(fine) for coarse, fine in zip(found, found[1:], strict=False)]
    numbers = [dict(numbers_of(result)) for result in found]
    check_same_numbers(found, numbers)
    endless = without_limit(found[-2:], ratios[-1])
    scales = dict[str, float]()
    for one in numbers:
        for (kind, _, _), value in one.items():
            scales[kind] = max(scales.get(kind, 0.0), abs(value))
    compared = []
    for key in numbers[-1]:
        kind, name, unit = key
        values = tuple(one[key] for one in numbers)
        if max(abs(value) for value in values) > ROUND_OFF * scales[kind]:
            error, order = bar(values, ratios, ROUND_OFF * scales[kind])
            is_force = kind == "force" or kind.startswith(QUANTITY)
            if kind == "work" and error is not None:
                error = max(error, energy_error(found[-1]))
            # A bar longer than a pressure, a work or a stress intensity factor is meaningless.
            if name in endless or not is_force and error is not None and error > abs(values[-1]):
                error = None
            compared.append(Compared(name, unit, values, error, order))
    return compared


def check_same_numbers(results: Sequence[Result], numbers: Sequence[Mapping[tuple[str, str, str], float]]) -> None:
    """Raises InputError where one of the results has a number that another lacks, with its name."""
    every = dict.fromkeys(key for one in numbers for key in one)
    for result, own in zip(results, numbers, strict=True):
        missing = [f"'{name}' in {unit}" for _, name, unit in every.keys() - own.keys()]
        if missing:
            shown = ", ".join(sorted(missing)[:4]) + (", …" if len(missing) > 4 else "")
            raise InputError(
                f"the results are of several scenes: {result.path} has no {shown}; expected the same contacts, supports"
                " and quantities in all, and meshes fine enough for stress intensity factors of the same crack tips"
            )


def bar(values: Sequence[float], ratios: Sequence[float], round_off: float) -> tuple[float | None, float | None]:
    """Error bar of the last value, and the order that the values show."""
    steps = [fine - coarse for coarse, fine in zip(values, values[1:], strict=False)]
    last = abs(steps[-1])
    if max(map(abs, steps)) <= round_off:
        return round_off, None
    if len(steps) == 1:
        return UNKNOWN * last / (ratios[0] - 1), None
    before = abs(steps[0])
    if steps[0] * steps[1] <= 0 or before <= round_off:
        # It goes to and fro.
        return UNKNOWN * max(before, last) / 2, None
    order = observed(before / last, *ratios)
    if order < ORDERS[0]:
        return None, order
    if order > ORDERS[1]:
        last = max(last, before / ratios[1] ** ORDERS[1])
    return OBSERVED * last / (ratios[1] ** min(order, ORDERS[1]) - 1), order


def observed(shrinks: float, first: float, second: float) -> float:
    """The order p with (first^p - 1) / (1 - second^-p) = `shrinks`, of differences on meshes `first` and then `second`
    times finer; 0 where there is none above."""
    low, high = 0.0, 20.0
    while high - low > 1e-6:
        p = (low + high) / 2
        if math.expm1(p * math.log(first)) < -shrinks * math.expm1(-p * math.log(second)):
            low = p
        else:
            high = p
    return low


def numbers_of(result: Result) -> Iterator[tuple[tuple[str, str, str], float]]:
    """Numbers to compare: kind, name and unit, and the value."""
    # With it comes matplotlib.
    from contact_dd.drawing.units import units_of

    report: dict[str, Any] = result.report
    units = units_of(result)
    for contact in report["contacts"]:
        if contact["largest_pressure"] is not None:
            name = PRESSURE + contact["name"]
            yield (name, name, units.stress), contact["largest_pressure"]
    for contact in report["contacts"]:
        for axis, force in zip("xyz", contact["force"], strict=True):
            yield ("force", f"force on {contact['name']}, {axis}", units.force), force
    for support in report["reactions"]:
        for axis, force in zip("xyz", support["force"], strict=True):
            yield ("force", f"reaction of {support['support']}, {axis}", units.force), force
    for tip in report.get("crack_tips", []):
        for key, symbol in (("k_i", "K_I"), ("k_ii", "K_II")):
            name = f"{symbol} of {tip['tip']}"
            yield ("stress intensity", name, f"{units.stress} √{units.length}"), tip[key]
    for quantity in report.get("quantities", []):
        if quantity["kind"] != "largest_pressure" and quantity["value"] is not None:
            name = f"{QUANTITY}{quantity['name']}"
            yield (name, name, units.of_quantity(quantity["kind"])), quantity["value"]
    if report.get("friction"):
        yield ("work", "work of friction", units.work), report["friction"]["dissipated_work"]


def energy_error(result: Result) -> float:
    """Half the square of the estimated error in the energy norm, in the load step where it is largest: the error of
    energies."""
    steps = result.report["steps"] or [result.report]
    estimates = [step["error_estimate"] for step in steps if step["error_estimate"]]
    return max((0.5 * float(estimate["error"]) ** 2 for estimate in estimates), default=0.0)


def without_limit(meshes: Sequence[Result], ratio: float) -> set[str]:
    """The names of largest pressures of contacts at whose rim the pressure grows from one of two meshes to the next, as
    at an edge or a tip, or bends. It need not be the largest yet."""
    # With it comes matplotlib.
    from contact_dd.drawing.rim import bent_at_rim, rim_pressures

    coarse, fine = (rim_pressures(mesh) for mesh in meshes)
    grow = {name for name, pressure in fine.items() if pressure > ratio**GROWTH * coarse.get(name, 0.0) > 0}
    return {PRESSURE + name for name in grow | bent_at_rim(meshes[-1])}
