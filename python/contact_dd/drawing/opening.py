"""The opening of a page on a run: title, summary in sentences, warnings, and key numbers."""

import numpy as np

from contact_dd.drawing.carried import WITHOUT_PRESSURE
from contact_dd.drawing.html import escape, section, short
from contact_dd.drawing.plane import von_mises
from contact_dd.drawing.units import si

STATES = {"strain": "in plane strain", "stress": "in plane stress", "axisymmetric": "around an axis", None: "in space"}
# Estimated errors of stresses up to which these are good, and usable.
GOOD, USABLE = 0.01, 0.05
# Certificates of results that are solved to round-off.
ROUND_OFF = 1e-12
# Share of the largest force below which a reaction is round-off.
NOTHING = 1e-9


def title_of(report, result, problem):
    """The heading with the status, and a line on files and machine."""
    good = report["status"] == "converged"
    status = "converged" if good else "not converged"
    ranks = f"{report['ranks']} rank{'s' * (report['ranks'] > 1)}"
    hosts = f"{report['hosts']} host{'s' * (report['hosts'] > 1)}"
    commit = report["build"]["commit"]
    build = escape(report["version"] + (f" ({commit[:10]})" if commit else ""))
    return (
        f'<h1>{escape(result.title or problem)}<span class="badge {"good" if good else "bad"}">{status}</span></h1>'
        f'<p class="sub">{escape(result.path.name)} of {escape(problem)} · {escape(ranks)} with '
        f'{escape(report["threads"])} thread{"s" * (report["threads"] > 1)} '
        f'on {escape(hosts)} · contact-dd-mpi {build}</p>'
    )


def cards(report):
    """The run in numbers."""
    found = [
        (f"{report['dofs']:,}".replace(",", " "), "degrees of freedom"),
        (report["subdomains"], "subdomains"),
        (f"{report['active_contacts']} of {report['contact_conditions']}", "contact constraints closed"),
        (report["sweeps"], f"sweeps of {report['method']}"),
        (si(report["seconds"]["total"], "s"), "from start to end"),
        (si(report["peak_memory_bytes"], "B"), "memory of all ranks"),
    ]
    if report.get("error_estimate"):
        relative = report["error_estimate"]["relative"]
        found.append(("–" if relative is None else f"{100 * relative:.2g} %", "error of the mesh, estimated"))
    return '<div class="cards">' + "".join(
        f'<div class="card"><b>{escape(value)}</b><span>{escape(name)}</span></div>' for value, name in found
    ) + "</div>"


def warnings(report):
    if not report["warnings"]:
        return ""
    items = "".join(f"<li>{escape(text)}</li>" for text in report["warnings"])
    return section("Warnings", f'<ul class="warnings">{items}</ul>')


def sentences(report, result, units):
    """Sentences that an engineer would write of the run."""
    found = [
        solved(report, result), stresses(result, units), pressures(report, result, units), balance(report, units),
    ]
    # Numbers that aren't to be used stand behind the warning.
    found.insert(len(found) if report["status"] == "converged" else 0, trust(report))
    return section("In short", "".join(f"<p>{escape(one)}</p>" for one in found if one))


def solved(report, result):
    """Sentence on the problem."""
    steps = f" in {result.steps} load steps" if result.steps > 1 else ""
    materials = len(np.unique(result.cell_data["Material"])) if "Material" in result.cell_data else 1
    contacts = len(report["contacts"])
    friction = " with friction" if report.get("friction") else ""
    of_contacts = f" {contacts} contact{'s' * (contacts != 1)}{friction}" if contacts else " no contact"
    last = " What follows is of the last one." if steps else ""
    dofs = f"{report['dofs']:,}".replace(",", " ")
    ended = "solved" if report["status"] == "converged" else "not solved"
    return (
        f"Linear elastic bodies of {materials if materials > 1 else 'one'} material{'s' * (materials != 1)} "
        f"{STATES.get(result.plane, 'in space')}, with{of_contacts} and {dofs} degrees of freedom, {ended}{steps} in "
        f"{si(report['seconds']['total'], 's')}.{last}"
    )


def stresses(result, units):
    """The largest stress and displacement, and where."""
    size = np.linalg.norm(result.displacement, axis=1)
    words = f"the largest displacement is {si(size.max(initial=0.0), units.length)}"
    if size.any():
        words += f", at {place(result, size.argmax(), units)}"
    if len(result.stress) == 0:
        return f"{words[0].upper()}{words[1:]}; stresses weren't evaluated."
    values = von_mises(result.stress)
    return (
        f"The largest von Mises stress is {si(values.max(), units.stress)}, at "
        f"{place(result, values.argmax(), units)}; {words}."
    )


def place(result, node, units):
    point = result.points[node][: 3 if result.is_in_space else 2]
    # Round-off relative to the size of the model.
    nothing = 1e-9 * np.ptp(result.points, axis=0).max()
    axes = zip("xyz" if result.is_in_space else "xy", point, strict=True)
    return ", ".join(f"{name} = {si(0 if abs(at) < nothing else at, units.length)}" for name, at in axes)


def pressures(report, result, units):
    """Sentence on forces of contacts."""
    contacts = [contact for contact in report["contacts"] if contact.get("kind") not in WITHOUT_PRESSURE]
    found = [contact for contact in contacts if contact["largest_pressure"]]
    if not contacts:
        return ""
    if not found:
        return "All contacts are open."
    most = max(found, key=lambda contact: contact["largest_pressure"])
    table = result.contacts.get(most["name"])
    where = ""
    if table is not None and len(table):
        point = table["position"][table["pressure"].argmax()]
        nearest = np.linalg.norm(result.points - point, axis=1).argmin()
        where = f", at {place(result, nearest, units)}"
    words = (
        f"The largest contact pressure is {si(most['largest_pressure'], units.stress)}, on {most['name']}{where}; "
        f"{report['active_contacts']} of {report['contact_conditions']} contact points are closed"
    )
    if report.get("friction"):
        words += f", of which {report['friction']['slipping']} slip"
    idle = [contact["name"] for contact in contacts if contact["closed"] == 0]
    if idle:
        words += f"; {', '.join(idle[:3])}{' and others' * (len(idle) > 3)} {'is' if len(idle) == 1 else 'are'} open"
    return words + "."


def balance(report, units):
    """Sentence on reactions, and the balance of forces."""
    off = report["certificate"].get("force_balance")
    words = "Loads and reactions balance" + ("" if off is None else f" to {short(off)} of the forces")
    sums = [sum(one["force"][k] or 0 for one in report["reactions"]) for k in range(3)] if report["reactions"] else []
    of_contacts = (abs(force or 0) for one in report["contacts"] for force in one["force"])
    largest = max([*map(abs, sums), *of_contacts], default=0)
    named = zip(sums, "xyz", strict=True)
    parts = [f"{si(force, units.force)} along {name}" for force, name in named if abs(force) > NOTHING * largest]
    if not parts:
        return f"{words}; supports carry nothing."
    return f"{words}: supports push on the bodies with {', '.join(parts)}."


def trust(report):
    """Sentence on the accuracy of the result."""
    if report["status"] != "converged":
        return "The run did not converge: its numbers show where the trouble is, and are not to be used."
    equilibrium = report["certificate"]["equilibrium"]
    if equilibrium is None or equilibrium > ROUND_OFF:
        words = f"The discrete problem is solved to {short(equilibrium)}, less than round-off allows: see the warnings"
    else:
        words = f"The discrete problem is solved to round-off ({short(equilibrium)})"
    relative = (report.get("error_estimate") or {}).get("relative")
    if relative is None:
        return f"{words}; how far the mesh is off isn't estimated."
    words += f"; by its mesh, stresses are off by about {100 * relative:.2g} % in the energy norm"
    if relative <= GOOD:
        return f"{words}, which is good; single peaks may be off by more."
    if relative <= USABLE:
        return f"{words}: usable for comparison, with single peaks off by more."
    return f"{words}: refine before stresses decide anything. Forces and displacements are closer than that."
