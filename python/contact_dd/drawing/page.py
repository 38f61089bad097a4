"""One page on a run, a file by itself: status, contacts, convergence, certificate, reactions, time and memory."""

import json
import pathlib

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.ticker import EngFormatter, MaxNLocator

from contact_dd.comparison import compare
from contact_dd.drawing import opening, space
from contact_dd.drawing.finite import check_finite
from contact_dd.drawing.gaps import honest_scale
from contact_dd.drawing.html import STYLE, Html, axes_of, escape, png, section, short, svg, table
from contact_dd.drawing.overview import overview
from contact_dd.drawing.pictures import automatic_scale
from contact_dd.drawing.plane import Plane
from contact_dd.drawing.sides import DIRECTION, sides_of
from contact_dd.drawing.units import formatter, si, units_of
from contact_dd.drawing.view import view

PHASES = ["read", "assemble", "factorize", "interface", "sweeps", "recover", "write"]
COLORS = ["#9aa5b1", "#5b8ff9", "#1f5fa8", "#d62728", "#ff9d4d", "#3a9d5d", "#6b7785"]
# Meanings of the checks of the solution, and their limits, where they have one.
CERTIFICATE = {
    "equilibrium": (1e-14, "forces at the nodes balance, relative to their terms"),
    "equilibrium_of_load": (1e-6, "the same, relative to the largest load"),
    "penetration": (1e-14, "bodies don't overlap, relative to the largest displacement"),
    "tension": (1e-12, "contacts don't pull, relative to the load"),
    "friction": (1e-9, "tangential forces are within their bounds and oppose slip"),
    "complementarity": (None, "where there is a gap there is no force"),
    "force_balance": (None, "loads and reactions sum to zero"),
    "moment_balance": (None, "so do their moments"),
    "interface_jump": (None, "the displacement is one across Γ"),
}
# How the conditions of a contact are drawn, by their status: open, closed (with friction: sticking), slipping.
SLIPPING, SHEAR = "#e8590c", "#7a3e9d"
STATES = {
    0: {"mfc": "white", "mec": "#8795a3", "mew": 0.8},
    1: {"color": "#1f5fa8"},
    2: {"color": SLIPPING},
}
# Number of sweeps up to which they are described in a sentence.
FEW_SWEEPS = 3
# Largest numbers of curves and rows, so that the page stays readable; further ones are listed by name.
MOST_CURVES = 12
MOST_ROWS = 24

FONTS = {
    "svg.fonttype": "none", "font.size": 9, "font.family": "sans-serif",
    "font.sans-serif": ["DejaVu Sans", "Arial", "Helvetica"],
}


def page(result, coarser=()):
    """The page of a result, in HTML; with error bars where there are results on coarser meshes. Raises `InputError`
    where a number that is drawn isn't finite."""
    check_finite(result)
    report, units = result.report, units_of(result)
    with plt.rc_context(FONTS):
        parts = [
            opening.title_of(report, result, problem_of(report)), bodies(result),
            opening.sentences(report, result, units), opening.warnings(report), opening.cards(report),
            steps(report, units), contacts(report, sides_of(result), units), convergence(report, result.convergence),
            certificate(report), reactions(report, units), tips(report, units), quantities(report, units),
            bars([*coarser, result]), ranks(report), rest(report),
        ]
    title = escape(result.title or problem_of(report))
    return (
        f'<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8"><title>{title}</title>'
        f"<style>{STYLE}</style></head>\n<body>\n" + "\n".join(parts) + "\n</body></html>\n"
    )


def problem_of(report):
    return pathlib.Path(report["settings"]["problem"]).name


def forces(found, unit):
    """Forces with their units; round-off of the largest counts as 0."""
    largest = max((abs(f) for one in found for f in one["force"] if f is not None), default=0)
    return [
        [si(f if f is None or abs(f) > 1e-9 * largest else 0, unit) for f in one["force"][: len(force_head("", found))]]
        for one in found
    ]


def force_head(first, found):
    """The names of the components of forces, behind `first`; z in space."""
    in_space = any(one["force"][2] for one in found)
    return [f"{first}x", "y", "z"][: 3 if in_space else 2]


def more(found, words):
    count = len(found) - MOST_ROWS
    return f"<p><small>and {count} more{words}; the report has all</small></p>" if count > 0 else ""


def bodies(result):
    """A picture of the bodies, and a view of them to be turned; none in the plane without stresses."""
    if result.is_in_space:
        scale = space.Solid(result).scale
        words = "The surface by displacement and von Mises stress, deformed; what presses, seen through the bodies"
        picture = png(space.panels(result), words)
    elif len(result.stress):
        plane = Plane(result)
        scale = automatic_scale(plane, honest_scale(plane))
        words = "The deformed shape by von Mises stress, with the contact pressures"
        picture = png(overview(plane, scale), words)
    else:
        return ""
    of_step = ", in the last load step" if result.steps > 1 else ""
    return section("The bodies", view(result, scale, f"{picture}<p><small>{words}{of_step}.</small></p>"))


def certificate(report):
    rows = []
    for name, (limit, meaning) in CERTIFICATE.items():
        value = report["certificate"].get(name)
        if name == "friction" and not report.get("friction"):
            continue
        mark = ""
        if limit is not None:
            holds = value is not None and value <= limit
            mark = Html('<b style="color:#17682f">✓</b>' if holds else '<b style="color:#9b1c14">✗</b>')
        rows.append([mark, name.replace("_", " "), short(value), short(limit) if limit else "", meaning])
    return section(
        "Certificate: the full discrete problem, checked",
        table(["", "", "found", "at most", ""], rows, numbers=(2, 3)),
    )


def convergence(report, rows):
    if report["contact_conditions"] == 0:
        return section("Convergence", "<p>No contact: one linear solve, no sweeps.</p>")
    residual, active = rows["residual"], rows["active"]
    sweeps = np.arange(len(residual))
    if len(sweeps) <= FEW_SWEEPS and not report.get("steps"):
        words = [f"{short(of)} with {closed} closed conditions" for of, closed in zip(residual, active)]
        return section("Convergence", f"<p>Residuals: {', '.join(words)}; the first is the bilateral start.</p>")
    figure, (left, right) = axes_of(9.2, 2.7, ncols=2)
    style = {"ms": 4, "lw": 1.4, "marker": None if len(sweeps) > 40 else "o"}
    # A line for each load step, which begins anew.
    of_steps = rows.get("step", np.zeros(len(sweeps)))
    starts = [0, *(1 + np.flatnonzero(np.diff(of_steps))), len(sweeps)]
    for first, last in zip(starts, starts[1:]):
        of_step = slice(first, last)
        left.semilogy(sweeps[of_step], np.maximum(residual[of_step], 1e-18), color="#1f5fa8", **style)
        right.plot(sweeps[of_step], active[of_step], color="#3a9d5d", **style)
    left.axhline(report["settings"]["tolerance"], color="#d62728", lw=1, ls="--")
    left.annotate("tolerance", (1, report["settings"]["tolerance"]), xycoords=("axes fraction", "data"),
                  ha="right", va="bottom", color="#d62728", fontsize=8)
    left.set_ylabel("residual")
    right.set_ylim(0, 1.08 * max(1, active.max()))
    right.set_ylabel("closed conditions")
    right.yaxis.set_major_locator(MaxNLocator(integer=True))
    for axes in (left, right):
        axes.set_xlabel("sweeps of all load steps" if report.get("steps") else "sweep (0: bilateral start)")
        axes.xaxis.set_major_locator(MaxNLocator(integer=True))
    return section("Convergence", svg(figure))


def steps(report, units):
    found = report.get("steps")
    if not found:
        return ""
    pressures = [max((c["largest_pressure"] or 0 for c in step["contacts"]), default=0) for step in found]
    times = [step["time"] for step in found]
    figure, (left, right) = axes_of(9.2, 2.4, ncols=2)
    left.plot(times, pressures, "o-", color="#1f5fa8", ms=4, lw=1.4)
    left.set_ylim(0, 1.1 * max(pressures) or 1)
    left.yaxis.set_major_formatter(formatter(units.stress))
    left.set_ylabel("largest pressure")
    right.plot(times, [step["active_contacts"] for step in found], "o-", color="#3a9d5d", ms=4, lw=1.4)
    right.set_ylim(0, None)
    right.set_ylabel("closed conditions")
    right.yaxis.set_major_locator(MaxNLocator(integer=True))
    for axes in (left, right):
        axes.set_xlabel("time")
        # As where steps have their numbers for times.
        if all(float(time).is_integer() for time in times):
            axes.xaxis.set_major_locator(MaxNLocator(integer=True))
    rows = [
        [step["name"], f"{step['time']:g}", step["status"].replace("_", " "), step["sweeps"],
         step["active_contacts"], si(pressure, units.stress), short(step["certificate"]["equilibrium"]),
         *friction_of(step, report, units)]
        for step, pressure in zip(found[:MOST_ROWS], pressures)
    ]
    head = ["step", "time", "", "sweeps", "closed", "largest pressure", "equilibrium", *friction_head(report)]
    text = "<p><small>What follows on contacts and reactions is that of the last step.</small></p>"
    rows = table(head, rows, numbers=(1, *range(3, len(head))))
    return section("Load steps", svg(figure), rows, more(found, ""), text)


def ranks(report):
    times = np.array([[rank[phase] for phase in PHASES] for rank in report["per_rank"]])
    totals = np.array([rank["total"] for rank in report["per_rank"]])
    rows = []
    for phase, column in [*zip(PHASES, times.T), ("total", totals)]:
        share = column.mean() / totals.mean() if totals.mean() > 0 else 0
        seconds = (column.min(), column.mean(), column.max()) if len(times) > 1 else column
        rows.append([phase, *(si(number, "s") for number in seconds), f"{100 * share:.0f} %"])
    if len(times) == 1:
        return section("Time", table(["phase", "", "share"], rows, numbers=(1, 2)))
    key = "".join(f'<span style="--c:{color}">{phase}</span>' for phase, color in
                  [*zip(PHASES, COLORS), ("waiting, other", "#e3e7eb")])
    memory = np.array([rank["peak_memory_bytes"] for rank in report["per_rank"]])
    return section("Time and memory", f'<p class="key">{key}</p>', svg(of_ranks(times, totals, memory)),
                   table(["phase", "least", "mean", "largest of a rank", "share"], rows, numbers=(1, 2, 3, 4)))


def of_ranks(times, totals, memory):
    count = len(times)
    places = np.arange(count)
    figure, (left, right) = axes_of(9.2, min(1.4 + 0.2 * count, 7.5), ncols=2, sharey=True, width_ratios=[2.2, 1])
    start = np.zeros(count)
    for phase, color, column in zip(PHASES, COLORS, times.T):
        left.barh(places, column, 0.8, left=start, color=color, label=phase)
        start += column
    left.barh(places, np.maximum(totals - start, 0), 0.8, left=start, color="#e3e7eb", label="waiting, other")
    left.set_xlabel("time")
    left.xaxis.set_major_formatter(EngFormatter("s"))
    left.set_ylabel("rank")
    left.set_yticks(places[:: max(1, -(-count // 32))])
    left.set_ylim(count - 0.4, -0.6)
    right.barh(places, memory, 0.8, color="#8d7bb8")
    right.set_xlabel("memory")
    right.xaxis.set_major_formatter(EngFormatter("B"))
    right.xaxis.set_major_locator(MaxNLocator(4))
    return figure


def curve(axes, name, side, units):
    pressure, shear, status = side.pressure, side.shear, side.status
    for rows, way in side.pieces:
        axes.fill_between(way, pressure[rows], color="#5b8ff9", alpha=0.25, lw=0)
        axes.plot(way, pressure[rows], color="#1f5fa8", lw=1.3)
        if len(pressure) <= 60:
            # On the axis they would be half of a circle.
            style = {"ls": "", "marker": "o", "ms": 2.6, "clip_on": False, "zorder": 3}
            for state, look in STATES.items():
                of_state = status[rows] == state
                axes.plot(way[of_state], pressure[rows][of_state], **look, **style)
        if shear is not None:
            axes.plot(way, shear[rows], color=SHEAR, lw=1.1)
    least = 0 if shear is None else min(0, shear.min())
    most = max(pressure.max(), 0 if shear is None else shear.max())
    axes.set_title(name if len(name) < 32 else name[:30] + "…", fontsize=9, loc="left", parse_math=False)
    axes.set_ylim(1.1 * least, 1.1 * most if most > 0 else 1)
    axes.xaxis.set_major_formatter(formatter(units.length))
    axes.yaxis.set_major_formatter(formatter(units.stress))
    axes.xaxis.set_major_locator(MaxNLocator(4))
    axes.yaxis.set_major_locator(MaxNLocator(4))
    axes.tick_params(labelsize=7.5)


def pressures(report, found, sides, units):
    """The curves of pressures with their description; none in space."""
    shown = [contact["name"] for contact in found if contact["name"] in sides][:MOST_CURVES]
    if not shown:
        return ""
    columns = min(3, len(shown))
    lines = -(-len(shown) // columns)
    height = 1.95 * lines + 0.1
    figure, panels = axes_of(9.2, height, layout=None, ncols=columns, nrows=lines, squeeze=False)
    # By hand: constrained_layout takes the room of a long name from the curves.
    figure.subplots_adjust(left=0.07, right=0.99, bottom=0.3 / height, top=1 - 0.25 / height, wspace=0.27, hspace=0.42)
    for name, axes in zip(shown, panels.flat):
        curve(axes, name, sides[name], units)
    for axes in panels.flat[len(shown) :]:
        axes.set_visible(False)
    text = f"Pressure over the arc length of side a, undeformed, {DIRECTION}; hollow where it is open. "
    if report.get("friction"):
        text += (
            f'<span style="color:{SLIPPING}">Orange</span> where it slips; the <span style="color:{SHEAR}">thin line'
            "</span> is the shear stress on side a, positive along its outward normal turned counter-clockwise. "
        )
    if len(found) > len(shown):
        text += f"The {len(shown)} of {len(found)} contacts with the largest pressures. "
    return f"<p><small>{text}</small></p>{svg(figure)}"


def contacts(report, sides, units):
    found = sorted(report["contacts"], key=lambda contact: -(contact["largest_pressure"] or 0))
    if not found:
        return ""
    rows = [
        [c["name"], f"{c['closed']} of {c['conditions']}", si(c["largest_pressure"], units.stress), *force,
         *friction_of(c, report, units)]
        for c, force in zip(found[:MOST_ROWS], forces(found, units.force))
    ]
    head = ["contact", "closed", "largest pressure", *force_head("force on side a, ", found), *friction_head(report)]
    return section(
        "Contacts", pressures(report, found, sides, units),
        table(head, rows, numbers=range(1, len(head))),
        more(found, " with lower pressures"),
    )


def friction_head(report):
    return ["slipping", "work of friction"] if report.get("friction") else []


def friction_of(part, report, units):
    """Number of conditions of a contact or a step that slip, and friction's work, where any contact has friction."""
    friction = part.get("friction")
    if friction:
        return [friction["slipping"], si(friction["dissipated_work"], units.work)]
    return ["–", "–"] if report.get("friction") else []


def reactions(report, units):
    if not report["reactions"]:
        return ""
    found = report["reactions"]
    rows = [[r["support"], *force] for r, force in zip(found[:MOST_ROWS], forces(found, units.force))]
    rows = table(["support", *force_head("", found)], rows, numbers=(1, 2, 3))
    return section("Reactions of supports", rows, more(found, ""))


def tips(report, units):
    found = report.get("crack_tips")
    if not found:
        return ""
    of_k, of_j = f"{units.stress} √{units.length}", units.force
    rows = [
        [tip["tip"], si(tip["k_i"], of_k, 4), si(tip["k_ii"], of_k, 4), si(tip["energy_release_rate"], of_j, 4),
         f"{100 * (tip['dependence_on_radius'] or 0):.2g} %"]
        for tip in found[:MOST_ROWS]
    ]
    words = (
        "The last column is the largest difference of the factors in smaller discs around the tip. Their error is of "
        "that size or larger; compare with a second mesh."
    )
    rows = table(["crack tip", "K_I", "K_II", "J", "by the disc"], rows, numbers=(1, 2, 3, 4))
    return section("Stress intensity", rows, more(found, ""), f"<p><small>{words}</small></p>")


def printed_error(one, units):
    error, bar, unit = one.get("error"), one.get("error_bar"), units.of_quantity(one["kind"])
    if error is None:
        return "–"
    # As the solver prints it; in reports without bars with the sign.
    return si(error, unit, 2) if bar is None or abs(error) >= 0.5 * bar else "± " + si(bar, unit, 2)


def quantities(report, units):
    found = report.get("quantities")
    if not found:
        return ""
    rows = [
        [one["name"], si(one["value"], units.of_quantity(one["kind"]), 5),
         printed_error(one, units), *most(one)]
        for one in found[:MOST_ROWS]
    ]
    words = (
        "The error of the mesh is an estimate of the value less the exact one; ± where its sign can't be "
        "trusted. The parameter is the one that changes a "
        "quantity most when it rises by its own size, and by how much of the quantity; the report has all derivatives."
    )
    if report.get("without_derivatives"):
        words = f"There are no derivatives: {report['without_derivatives']}."
    elif report.get("about_to_change"):
        words += f" They hold on one side: {'; '.join(report['about_to_change'])} is about to change its status."
    rows = table(["quantity", "", "error of the mesh", "depends most on", "by"], rows, numbers=(1, 2, 4))
    return section("Quantities", rows, more(found, ""), f"<p><small>{escape(words)}</small></p>")


def most(quantity):
    """The parameter with the largest relative effect on a quantity, and that effect; without parameters of value 0."""
    shares = [
        (one["derivative"] * one["at"] / quantity["value"], one["parameter"])
        for one in quantity["derivatives"]
        if one["at"] and one["derivative"] and quantity["value"]
    ]
    if not shares:
        return ["–", "–"]
    share, name = max(shares, key=lambda one: abs(one[0]))
    return [name, f"{100 * share:+.3g} %"]


def bars(results):
    """Errors of pressures and forces, by comparison of meshes."""
    if len(results) == 1:
        return ""
    found = compare(results)
    rows = [
        [one.name, si(one.values[-1], one.unit, 5), f"± {si(one.error, one.unit, 2)}" if one.error else "–",
         "" if one.order is None else f"{one.order:.1f}"]
        for one in found[:MOST_ROWS]
    ]
    meshes = len(found[0].values) - 1 if found else 1
    words = (
        f"By comparison with {meshes} coarser mesh{'es' * (meshes > 1)}. A line where the number doesn't converge: at "
        "an edge or a tip, or as the meshes are too coarse."
    )
    table_of = table(["", "", "off at most", "order"], rows, numbers=(1, 2, 3))
    return section("Error bars", table_of, more(found, ""), f"<p><small>{words}</small></p>")


def rest(report):
    settings = ", ".join(
        f"{name.replace('_', ' ')} {json.dumps(value) if isinstance(value, bool) else value}"
        for name, value in report["settings"].items()
        if value not in (None, False)
    )
    rows = [["settings", settings]]
    rows += [[f"{name} " if i == 0 else "", text] for name in ("skipped", "fallbacks")
             for i, text in enumerate(report[name])]
    rows += [[name, report["build"][name]] for name in ("mpi", "hdf5", "compiler", "profile", "commit")
             if report["build"][name]]
    if report["condition_number"] is not None:
        rows.insert(1, ["condition", f"about {short(report['condition_number'])}"])
    return section("How it was made", table(["", ""], rows))
