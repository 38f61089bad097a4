"""The report of a run as the package reads it: required fields and their types."""

from __future__ import annotations

import json
import math
from typing import Any

# A type, alternatives, a list with the shape of its entries, or a mapping with its required keys.
Shape = Any

NUMBER = (int, float)
# The solver writes numbers that aren't finite as null.
MAYBE = (int, float, type(None))

FRICTION: Shape = {"slipping": int, "dissipated_work": MAYBE}
CONTACT: Shape = {
    "name": str, "conditions": int, "closed": int, "largest_pressure": MAYBE, "force": [MAYBE],
    "friction": (dict, type(None)),
}
ESTIMATE: Shape = {"energy_norm": MAYBE, "error": MAYBE, "relative": MAYBE}
PHASES = ("read", "assemble", "factorize", "interface", "sweeps", "recover", "write", "total")
CHECKS = (
    "equilibrium", "equilibrium_of_load", "penetration", "tension", "friction", "complementarity", "force_balance",
    "moment_balance", "interface_jump",
)
STEP: Shape = {
    "name": str, "time": NUMBER, "status": str, "sweeps": int, "active_contacts": int, "contacts": [CONTACT],
    "certificate": dict.fromkeys(CHECKS, MAYBE), "absent": [str],
}
REPORT: Shape = {
    "status": str, "method": str, "sweeps": int, "dofs": int, "subdomains": int, "ranks": int, "hosts": int,
    "threads": int, "active_contacts": int, "contact_conditions": int, "peak_memory_bytes": int, "version": str,
    "certificate": dict.fromkeys(CHECKS, MAYBE), "condition_number": MAYBE, "seconds": {"total": NUMBER},
    "contacts": [CONTACT], "reactions": [{"support": str, "force": [MAYBE]}], "steps": [STEP],
    "per_rank": [{**dict.fromkeys(PHASES, NUMBER), "peak_memory_bytes": int}],
    "skipped": [str], "warnings": [str], "fallbacks": [str], "settings": {"problem": str, "tolerance": NUMBER},
    "build": dict.fromkeys(("mpi", "hdf5", "compiler", "profile", "commit"), (str, type(None))),
}
TIP: Shape = {
    "tip": str, "node": int, "position": [MAYBE], "direction": [MAYBE], "k_i": MAYBE, "k_ii": MAYBE,
    "energy_release_rate": MAYBE, "radius": MAYBE, "dependence_on_radius": MAYBE,
}
DERIVATIVE: Shape = {"parameter": str, "kind": str, "at": MAYBE, "derivative": MAYBE}
QUANTITY: Shape = {
    "name": str, "kind": str, "value": MAYBE, "error": MAYBE, "node": (int, type(None)), "derivatives": [DERIVATIVE],
}
# Fields that may be null or missing.
OPTIONAL: dict[str, Shape] = {
    "error_estimate": ESTIMATE, "friction": FRICTION, "crack_tips": [TIP], "quantities": [QUANTITY],
    "about_to_change": [str], "without_derivatives": str,
}


def report_of(text: str | bytes) -> dict[str, Any]:
    """The report that a result file holds as JSON. Raises `ValueError` where it is no such report."""
    try:
        report = json.loads(text)
    except ValueError as error:
        raise ValueError(f"its report isn't JSON: {error}") from error
    check(report, REPORT, "")
    parts = [report, *report["steps"], *report["contacts"], *(c for step in report["steps"] for c in step["contacts"])]
    for part in parts:
        for name, shape in OPTIONAL.items():
            if part.get(name) is not None:
                check(part[name], shape, f"/{name}")
    found: dict[str, Any] = report
    return found


def check(value: Any, shape: Shape, where: str) -> None:
    """Raises `ValueError` where a value of a report isn't of the shape that it should have."""
    kind = dict if isinstance(shape, dict) else list if isinstance(shape, list) else shape
    # Of JSON's values a truth isn't a number, of Python's it is.
    is_finite = not isinstance(value, float) or math.isfinite(value)
    if not isinstance(value, kind) or isinstance(value, bool) or not is_finite:
        words = kind if isinstance(kind, tuple) else (kind,)
        expected = " or ".join(dict.fromkeys(WORDS[word] for word in words))
        raise ValueError(f"its report has {json.dumps(value)[:40]} at {where or '/'}; expected {expected}")
    if isinstance(shape, dict):
        for name, of in shape.items():
            if name not in value:
                raise ValueError(f"its report has nothing at {where}/{name}")
            check(value[name], of, f"{where}/{name}")
    elif isinstance(shape, list):
        for number, entry in enumerate(value):
            check(entry, shape[0], f"{where}/{number}")


WORDS = {
    str: "text", int: "a number", float: "a number", dict: "an object", list: "a list", type(None): "null",
}
