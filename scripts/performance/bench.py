"""Measures contact-dd-mpi against PARDISO and CHOLMOD on the granite block, and by itself on walls of
bricks; run it by scripts/bench.

Every repetition runs all of them one after the other; a ratio is the median of the repetitions'
ratios, a time the median of the times.
"""

import json
import math
import os
import signal
import statistics
import sys
import time

import options
import reference
import runs
import wall
from runs import PHASES, SOLVE_PHASES

TWO = "2 ranks"
ONE = "1 rank"
PARDISO = "PARDISO, 2 threads"
PARDISO_ONE = "PARDISO, 1 thread"
CHOLMOD = "CHOLMOD, 1 thread"
ACTIVE_SET = "active set on PARDISO, 2 threads"
PARTITION = "partition tool"
# Factorizations of the active set, for the choice of what suits it.
TYPICAL_STEPS = 8
# The solver's agreement with the references, as the difference of displacements: more than the
# condition makes of round-off would be another solution.
LARGEST_DIFFERENCE = 1e-8


def measure(dofs, arguments):
    """All runs of one size."""
    path = runs.problem(dofs, arguments.programs, arguments.subdomains)
    runs.say(f"{runs.name_of(dofs)}: assembling the references' matrix")
    system = reference.System(path)
    conditions = reference.Conditions(system)
    cholmod = reference.Cholmod(system, runs.FOLDER)
    results = {threads: reference.tried(system, threads) for threads in (1, 2)}
    choices = {
        PARDISO_ONE: reference.fastest(results[1]),
        PARDISO: reference.fastest(results[2]),
        ACTIVE_SET: reference.fastest(results[2], TYPICAL_STEPS),
    }
    for name, choice in choices.items():
        runs.say(f"{runs.name_of(dofs)}: {name}: {choice} is the fastest")

    result = runs.FOLDER / "result.vtkhdf"
    size = {"dofs": dofs, "choices": choices, "tried": results, "repetitions": []}
    size["flops"] = flops(dofs, path, cholmod, arguments)
    for repetition in range(arguments.repeat):
        taken = {}
        for name, ranks in ((ONE, 1), (TWO, 2)):
            taken[name] = runs.solve(path, ranks, arguments.programs, result)
        again = runs.FOLDER / "again.h5"
        tool = runs.partition(runs.granite(dofs), again, arguments.programs, arguments.subdomains)
        taken[PARTITION] = {"total": tool}
        again.unlink()
        taken[PARDISO_ONE], _ = reference.linear(system, 1, choices[PARDISO_ONE])
        taken[PARDISO], u = reference.linear(system, 2, choices[PARDISO])
        taken[CHOLMOD], v = cholmod.linear()
        taken[ACTIVE_SET], w = reference.active_set(conditions, 2, choices[ACTIVE_SET])
        if repetition == 0:
            size["checks"] = {
                "residual of PARDISO": system.residual(u),
                "residual of CHOLMOD": system.residual(v),
                "difference to the active set": system.difference(w, result),
                "closed": [taken[TWO]["active_contacts"], taken[ACTIVE_SET]["closed"]],
            }
            runs.say(f"{runs.name_of(dofs)}: {checked(size['checks'])}")
        size["repetitions"].append(taken)
        runs.say(
            f"{runs.name_of(dofs)}, {repetition + 1} of {arguments.repeat}: "
            + ", ".join(f"{name} {seconds(taken[name]):.3f} s" for name in taken)
        )
    cholmod.free()
    result.unlink()
    return size


def flops(dofs, path, cholmod, arguments):
    """Of nested dissection of the linear problem, of ours with all contacts, and of ours without any."""
    scene = runs.granite(dofs)
    without = scene.with_stem(f"{scene.stem}-open")
    without.write_text(scene.read_text().split("[[contact]]")[0])
    linear = runs.partitioned(without, arguments.programs, arguments.subdomains)
    return {
        "nested dissection": cholmod.nested_dissection(),
        "with contacts": runs.flops(path, arguments.programs),
        "without": runs.flops(linear, arguments.programs),
    }


def measure_wall(size, arguments):
    """A wall of bricks on 1 and 2 ranks, and tied on 2."""
    scene = runs.FOLDER / "meshes" / f"{wall.name(*size)}.toml"
    if not scene.exists():
        runs.call([sys.executable, wall.__file__, *size, scene.parent])
    paths = [
        runs.partitioned(scene.with_stem(wall.name(*size, tied)), arguments.programs) for tied in (False, True)
    ]
    result = runs.FOLDER / "result.vtkhdf"
    repetitions = []
    for repetition in range(arguments.repeat):
        repetitions.append({
            ONE: runs.solve(paths[0], 1, arguments.programs, result),
            TWO: runs.solve(paths[0], 2, arguments.programs, result),
            "tied": runs.solve(paths[1], 2, arguments.programs, result),
        })
        taken = repetitions[-1]
        runs.say(f"{scene.stem}, {repetition + 1} of {arguments.repeat}: "
                 + ", ".join(f"{name} {seconds(taken[name]):.3f} s" for name in taken))
    result.unlink()
    return {"size": size, "repetitions": repetitions}


def seconds(taken, phase="total"):
    """Seconds of a phase, of a run of ours or of a reference."""
    return taken.get("seconds", taken)[phase]


def median(size, name, phase="total"):
    return statistics.median(seconds(taken[name], phase) for taken in size["repetitions"])


def ratio(size, ours, phase, theirs, their_phase="total"):
    """Median of the repetitions' ratios."""
    return statistics.median(
        seconds(taken[ours], phase) / seconds(taken[theirs], their_phase)
        for taken in size["repetitions"]
    )


def checked(checks):
    """What the checks of the answers say; ends where one is wrong."""
    ours, theirs = checks["closed"]
    difference = checks["difference to the active set"]
    text = (
        f"our displacements differ by {difference:.1e} of the largest from the active set's "
        f"({ours} and {theirs} closed); backward error of PARDISO {checks['residual of PARDISO']:.0e}, "
        f"of CHOLMOD {checks['residual of CHOLMOD']:.0e}"
    )
    solved = max(checks["residual of PARDISO"], checks["residual of CHOLMOD"]) < reference.LARGEST_RESIDUAL
    if not (solved and difference < LARGEST_DIFFERENCE):
        sys.exit(f"bench: one of the answers is wrong: {text}")
    return text


def targets(sizes, walls):
    """Rows of the table of targets; `sizes` by their name, `walls` by their sizes."""
    rows = []

    def row(words, limit, value):
        rows.append([words, f"≤ {limit:g}", f"{value:.2f}", "yes" if value <= limit else "no"])

    def of(name, words, limit, value):
        if name in sizes:
            row(f"{words}, {name}", limit, value(sizes[name]))

    whole = "whole run, file to file, over PARDISO's linear solve in memory"
    of("500k", whole, 0.5, lambda size: ratio(size, TWO, "total", PARDISO))
    of("2M", whole, 0.5, lambda size: ratio(size, TWO, "total", PARDISO))
    of("80k", "solve phases over PARDISO's linear solve", 1.0,
       lambda size: ratio(size, TWO, "solve", PARDISO))
    of("500k", "whole run over the active set on PARDISO", 0.6,
       lambda size: ratio(size, TWO, "total", ACTIVE_SET))
    of("500k", "all sweeps over the factorization", 0.10, lambda size: ratio(size, TWO, "sweeps", TWO, "factorize"))
    of("500k", "solve phases, 2 ranks over 1", 0.6, lambda size: ratio(size, TWO, "solve", ONE, "solve"))
    of("80k", "with the launcher, over PARDISO's linear solve", 1.5, lambda size: ratio(size, TWO, "wall", PARDISO))
    of("2M", "partition tool over whole run", 0.35, lambda size: ratio(size, PARTITION, "total", TWO))
    of("2M", "flops over nested dissection's, no contact", 1.15, lambda size: over_dissection(size, "without"))
    of("2M", "flops over nested dissection's, contacts", 1.25, lambda size: over_dissection(size, "with contacts"))
    if options.WALLS["wall"] in walls:
        row("wall of bricks, whole run, s", 1.5, median(walls[options.WALLS["wall"]], TWO))
        row("wall of bricks, 2 ranks over 1", 0.65, ratio(walls[options.WALLS["wall"]], TWO, "total", ONE))
    if options.WALLS["many"] in walls:
        row("20k conditions over the same wall tied", 3, ratio(walls[options.WALLS["many"]], TWO, "total", "tied"))
    if "80k" in sizes and "2M" in sizes:
        small, large = sizes["80k"], sizes["2M"]
        growth = median(large, TWO) / median(small, TWO)
        dofs = actual(large) / actual(small)
        row("exponent of the total time in dofs, 80k to 2M", 1.2, math.log(growth) / math.log(dofs))
    return rows


def over_dissection(size, which):
    return size["flops"][which] / size["flops"]["nested dissection"]


def actual(size):
    return size["repetitions"][0][TWO]["dofs"]


def table(heads, rows, markdown):
    """A table as text or in Markdown; all columns but the first are numbers."""
    rows = [[str(cell) for cell in row] for row in rows]
    widths = [max(len(row[i]) for row in [heads, *rows]) for i in range(len(heads))]

    def line(row):
        cells = [row[0].ljust(widths[0])] + [c.rjust(w) for c, w in zip(row[1:], widths[1:])]
        return "| " + " | ".join(cells) + " |" if markdown else "  ".join(cells).rstrip()

    if markdown:
        rule = "|" + "|".join(["-" * (widths[0] + 2)] + ["-" * (w + 1) + ":" for w in widths[1:]]) + "|"
    else:
        rule = "  ".join("-" * w for w in widths)
    return "\n".join([line(heads), rule, *map(line, rows)]) + "\n"


def show(measured, markdown):
    """All tables."""
    sizes = {runs.name_of(size["dofs"]): size for size in measured["sizes"]}
    walls = {tuple(one["size"]): one for one in measured["walls"]}
    repeat = len([*sizes.values(), *walls.values()][0]["repetitions"])

    def heading(text):
        print(f"### {text}\n" if markdown else f"{text}\n")

    print(f"{measured['date']}, {measured['machine']}. Medians of {repeat}, times in s.")
    if sizes:
        cholmod = measured["sizes"][0]["repetitions"][0][CHOLMOD]
        print(f"MKL {measured['mkl']}, CHOLMOD {cholmod['version']} with {cholmod['blas']}.")
    print()
    rows = targets(sizes, walls)
    if rows:
        heading("Targets, 2 ranks")
        print(table(["ratio", "target", "measured", "met"], rows, markdown))

    if sizes:
        show_sizes(sizes, heading, markdown)
    if walls:
        heading("Walls of bricks")
        heads = ["conditions", "dofs", "whole run, 1 rank", "2 ranks", "2 ranks / 1 rank", "all bricks tied, 2 ranks",
                 "2 ranks / tied", "memory, GB", "of tied"]
        rows = [
            [
                *(one["repetitions"][0][TWO][key] for key in ("contact_conditions", "dofs")),
                *(f"{median(one, name):.3f}" for name in (ONE, TWO)),
                f"{ratio(one, TWO, 'total', ONE):.2f}",
                f"{median(one, 'tied'):.3f}",
                f"{ratio(one, TWO, 'total', 'tied'):.2f}",
                *(f"{memory(one, name):.2f}" for name in (TWO, "tied")),
            ]
            for one in walls.values()
        ]
        print(table(heads, rows, markdown))


def show_sizes(sizes, heading, markdown):
    """The granite block: all sizes, and the largest phase by phase."""
    heading("Overview")
    heads = ["dofs", "whole run, 1 rank", "2 ranks", "solve phases, 1 rank", "2 ranks", "PARDISO, 1 thread",
             "2 threads", "CHOLMOD, 1 thread", "active set, 2 threads", "whole run / PARDISO", "memory, GB",
             "of PARDISO", "partition tool", "flops / nested dissection's", "without contact"]
    rows = [
        [
            f"{actual(size):,}".replace(",", " "),
            *(f"{median(size, name, phase):.3f}" for phase in ("total", "solve") for name in (ONE, TWO)),
            *(f"{median(size, name):.3f}" for name in (PARDISO_ONE, PARDISO, CHOLMOD, ACTIVE_SET)),
            f"{ratio(size, TWO, 'total', PARDISO):.2f}",
            f"{memory(size, TWO):.2f}",
            f"{memory(size, PARDISO):.2f}",
            f"{median(size, PARTITION):.3f}",
            *(f"{over_dissection(size, which):.2f}" for which in ("with contacts", "without")),
        ]
        for size in sizes.values()
    ]
    print(table(heads, rows, markdown))

    show_size(*list(sizes.items())[-1], heading, markdown)


def memory(size, name):
    """GB, at the peak; of ours over all ranks."""
    taken = [repetition[name] for repetition in size["repetitions"]]
    return max(one.get("peak_memory_bytes", one.get("memory")) for one in taken) / 1e9


def show_size(name, size, heading, markdown):
    run = size["repetitions"][0][TWO]
    heading(name)
    print(
        f"{run['dofs']} dofs, {run['subdomains']} subdomains, {run['interface_dofs']} dofs on Γ, "
        f"{run['active_contacts']} of {run['contact_conditions']} conditions closed, {run['sweeps']} sweep{'s' * (run['sweeps'] != 1)}; "
        f"the active set on PARDISO takes "
        f"{size['repetitions'][0][ACTIVE_SET]['steps']} steps. Nested dissection takes "
        f"{size['flops']['nested dissection'] / 1e9:.3g} Gflop, ours {size['flops']['with contacts'] / 1e9:.3g}, without "
        f"contact {size['flops']['without'] / 1e9:.3g}. PARDISO's choices: {size['choices'][PARDISO_ONE]} with 1 "
        f"thread, {size['choices'][PARDISO]} with 2, {size['choices'][ACTIVE_SET]} for the active set. Checked: {checked(size['checks'])}.\n"
    )
    parts = {**{phase: phase for phase in PHASES}, "solve": f"{SOLVE_PHASES[0]} to {SOLVE_PHASES[-1]}",
             "total": "whole run", "wall": "with the launcher"}
    rows = [
        [words, f"{median(size, ONE, phase):.4f}", f"{median(size, TWO, phase):.4f}",
         f"{ratio(size, TWO, phase, ONE, phase):.2f}", f"{ratio(size, TWO, phase, PARDISO):.2f}"]
        for phase, words in parts.items()
    ]
    rows.append(["peak memory, GB", f"{memory(size, ONE):.2f}", f"{memory(size, TWO):.2f}",
                 f"{memory(size, TWO) / memory(size, ONE):.2f}", f"{memory(size, TWO) / memory(size, PARDISO):.2f}"])
    print(table(["phase", ONE, TWO, "2 ranks / 1 rank", "2 ranks / PARDISO, 2 threads"], rows, markdown))

    rows = []
    for other, ours in ((PARDISO_ONE, ONE), (PARDISO, TWO), (CHOLMOD, ONE), (ACTIVE_SET, TWO)):
        rows.append([
            other, *(f"{median(size, other, part):.4f}" for part in ("symbolic", "factor", "solve", "total")),
            f"{memory(size, other):.2f}", ours, f"{ratio(size, ours, 'total', other):.2f}",
            f"{ratio(size, ours, 'solve', other):.2f}",
        ])
    heads = ["reference", "symbolic", "factor", "solve", "total", "memory, GB", "ours with",
             "whole run / it", "solve phases / it"]
    print(table(heads, rows, markdown))


def mkl_version():
    from importlib.metadata import version

    return version("mkl")


def main():
    # Where nobody reads on, as behind `| head`, there is nothing more to do.
    signal.signal(signal.SIGPIPE, signal.SIG_DFL)
    arguments = options.bench(sys.argv[1:])
    if arguments.tables:
        show(json.loads(arguments.tables.read_text()), arguments.markdown)
        return

    measured = {"date": time.strftime("%Y-%m-%d"), "machine": runs.machine(), "mkl": mkl_version(), "sizes": [], "walls": []}
    if os.getloadavg()[0] > 0.7 * len(os.sched_getaffinity(0)):
        runs.say(f"bench: the machine is busy (load {os.getloadavg()[0]:.1f}): times and ratios will be off")
    runs.FOLDER.mkdir(parents=True, exist_ok=True)
    tasks = [("sizes", measure, size) for size in arguments.sizes]
    tasks += [("walls", measure_wall, options.WALLS[name]) for name in arguments.walls]
    for kind, measure_one, size in tasks:
        measured[kind].append(measure_one(size, arguments))
        (runs.FOLDER / "measurements.json").write_text(json.dumps(measured, indent=1))
    show(measured, arguments.markdown)


main()
