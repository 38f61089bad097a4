"""Units of a result, and numbers with them."""

from dataclasses import dataclass, replace

import numpy as np
from matplotlib.ticker import EngFormatter, FuncFormatter


@dataclass(frozen=True)
class Units:
    """Symbols of the units. Units that have a prefix themselves are shown without another."""

    length: str = "m"
    stress: str = "Pa"
    force: str = "N/m"
    work: str = "J/m"
    moment: str = "N"

    def of_quantity(self, kind):
        """Of a quantity of a scene."""
        if kind in ("displacement", "opening"):
            return self.length
        if kind in ("reaction", "contact_force"):
            return self.force
        if kind in ("k_i", "k_ii"):
            return f"{self.stress} √{self.length}"
        if kind == "energy_release_rate":
            return KNOWN[self.length].force
        if kind == "contact_moment":
            return self.moment
        return self.work if kind == "energy" else self.stress


KNOWN = {"m": Units(), "mm": Units("mm", "MPa", "N/mm")}


def units_of(result):
    """The symbols of a result's units; forces in the plane are those per thickness, but not around an axis."""
    known = KNOWN[result.units]
    whole = result.is_in_space or result.plane == "axisymmetric"
    work = {"m": "J", "mm": "mJ"}[known.length]
    return replace(known, force="N", work=work, moment=f"N {known.length}") if whole else known


def has_prefix(unit):
    return unit in ("mm", "MPa", "MPa √mm", "N/mm", "N mm", "mJ")


def in_units(values, unit):
    """Values and unit with the prefix that suits them."""
    if has_prefix(unit):
        return values, unit
    largest = np.abs(values).max(initial=0.0)
    for factor, prefix in ((1e9, "G"), (1e6, "M"), (1e3, "k"), (1.0, ""), (1e-3, "m")):
        if unit == "m" and factor > 1.0:
            continue
        if largest * (1 + 1e-6) >= factor:
            return values / factor, prefix + unit
    return (values / 1e-6, "µ" + unit) if largest > 0 else (values, unit)


def si(value, unit, digits=3):
    """A number with its unit: 8.32 MPa."""
    if value is None:
        return "–"
    if value == 0:
        return f"0 {unit}"
    # Rounded first: 999.9 k is 1 M.
    value = float(f"{value:.{digits}g}")
    if has_prefix(unit):
        return f"{value:g} {unit}"
    power = int(np.clip(np.floor(np.log10(abs(value)) / 3), -3, 3))
    prefix = {-3: "n", -2: "µ", -1: "m", 0: "", 1: "k", 2: "M", 3: "G"}[power]
    return f"{value / 10.0 ** (3 * power):.{digits}g} {prefix}{unit}"


def formatter(unit):
    """Of the ticks of an axis."""
    if has_prefix(unit):
        return FuncFormatter(lambda value, _: f"{value:g} {unit}")
    return EngFormatter(unit, sep=" ")
