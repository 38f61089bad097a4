"""Strong and weak scaling of contact-dd-mpi on the granite block or on two boxes; run it by scripts/scaling.

Every run leaves its report in FOLDER/reports; scaling.csv and scaling.svg are made from all reports
that are there, so that runs may be added later or come from several jobs.
"""

import csv
import json
import os
import signal
import statistics
import sys

import numpy as np
import options
import runs
from runs import PHASES

COLORS = dict(zip(PHASES, ["#b8c2cc", "#5b8ff9", "#1f5fa8", "#d62728", "#ff9d4d", "#3a9d5d", "#6b7785"]))


def ranks_up_to(most):
    """1, 2, 4, ... and `most`."""
    counts = [1 << i for i in range(most.bit_length()) if 1 << i <= most]
    return counts if counts[-1] == most else [*counts, most]


def problem_of(kind, ranks, arguments):
    if kind == "strong":
        if arguments.problem:
            return arguments.problem
        dofs, subdomains = arguments.strong, arguments.subdomains
    else:
        dofs = arguments.weak * ranks
        subdomains = arguments.subdomains_per_rank and arguments.subdomains_per_rank * ranks
    return runs.problem(dofs, arguments.programs, subdomains, arguments.scene, arguments.friction)


def measure(kind, ranks, repetition, arguments):
    path = problem_of(kind, ranks, arguments)
    name = f"{kind}-{ranks}-{repetition}"
    result = arguments.folder / f"{name}.vtkhdf"
    options = ["--threads", arguments.threads]
    if arguments.interface:
        options += ["--interface", arguments.interface]
    run = runs.solve(path, ranks, arguments.programs, result, options)
    result.unlink()
    run["scaling"] = {"kind": kind, "repetition": repetition}
    reports = arguments.folder / "reports"
    reports.mkdir(exist_ok=True)
    (reports / f"{name}.json").write_text(json.dumps(run, indent=1))
    runs.say(f"{kind}, {ranks} ranks, repetition {repetition}: {run['seconds']['total']:.3f} s by the clock, "
             f"{modelled_total(run)} s with a core for each rank, modelled")


def modelled_total(run):
    """Seconds of the slowest rank, each with a core of its own."""
    times = [rank["modelled"]["total"] for rank in run["per_rank"] if "modelled" in rank]
    return f"{max(times):.3f}" if times else "?"


def modelled(group):
    """What the reports say of ranks with a core each and a network, where they do: the slowest rank's times, the largest
    number of messages of a rank, the longest chain of them."""
    def median(of):
        return round(statistics.median(max(of(rank) for rank in run["per_rank"]) for run in group), 6)

    if any("modelled" not in rank for run in group for rank in run["per_rank"]):
        return {"modelled_total": ""}
    return {
        **{f"modelled_{key}": median(lambda rank: rank["modelled"][key]) for key in [*PHASES, "total"]},
        "work_total": round(statistics.median(
            sum(rank["work"]["total"] for rank in run["per_rank"]) for run in group), 6),
        "messages_sent_by_largest": median(lambda rank: rank["messages_sent"]),
        "longest_chain": median(lambda rank: rank["longest_chain"]),
    }


def fitted(rows, key, ranks):
    """What a phase would take on more `ranks`, by its times t = a + b log p + c p on p ranks, none of them negative."""
    counts = np.array([row["ranks"] for row in rows], dtype=float)
    times = np.array([row[f"modelled_{key}"] for row in rows])
    terms = [np.ones_like, np.log2, np.copy]
    best = (np.inf, 0.0)
    for chosen in range(1, 8):
        own = [term for k, term in enumerate(terms) if chosen >> k & 1]
        matrix = np.stack([term(counts) for term in own], axis=1)
        # As good in proportion everywhere.
        weights, *_ = np.linalg.lstsq(matrix / times[:, None], np.ones_like(times), rcond=None)
        off = np.square(matrix @ weights / times - 1).sum()
        if (weights >= 0).all() and len(own) <= len(rows) and off < best[0]:
            best = (off, sum(w * term(np.array([float(ranks)]))[0] for w, term in zip(weights, own)))
    return best[1]


def print_model(rows, far):
    """Tables of the modelled times, with those that are fitted on `far` ranks at the end."""
    heads = ["ranks", "dofs", *PHASES, "total", "efficiency", "messages", "chain", "MB of largest"]
    for kind in sorted({row["kind"] for row in rows}):
        own = [row for row in rows if row["kind"] == kind and row["modelled_total"] != ""]
        if not own:
            continue
        print(f"\n{kind} scaling, modelled times in s: a core for each rank, messages by a network (docs/scaling.md)\n\n| " + " | ".join(heads) + " |\n|" + "--:|" * len(heads))
        for row in own:
            times = [f"{row[f'modelled_{key}']:.3g}" for key in [*PHASES, "total"]]
            print("| " + " | ".join(map(str, [
                row["ranks"], row["dofs"], *times, f"{100 * row['efficiency_modelled_total']:.0f} %",
                round(row["messages_sent_by_largest"]), round(row["longest_chain"]),
                round(row["peak_memory_of_largest"] / 1e6)])) + " |")
        for ranks in far if kind == "weak" and len(own) > 2 else []:
            phases = [fitted(own, key, ranks) for key in PHASES]
            share = 100 * own[0]["modelled_total"] / sum(phases)
            cells = [ranks, "fitted", *(f"{t:.3g}" for t in [*phases, sum(phases)]), f"{share:.1f} %", "", "", ""]
            print("| " + " | ".join(map(str, cells)) + " |")


def collect(folder):
    """A row for each kind and number of ranks: medians over the repetitions."""
    groups = {}
    for path in sorted((folder / "reports").glob("*.json")):
        run = json.loads(path.read_text())
        groups.setdefault((run["scaling"]["kind"], run["ranks"]), []).append(run)
    if not groups:
        sys.exit(f"scaling: no reports in {folder / 'reports'}")
    rows = []
    for (kind, ranks), group in sorted(groups.items()):
        sent = [[rank.get("bytes_sent") for rank in run["per_rank"]] for run in group]
        known = all(None not in bytes_of for bytes_of in sent)
        middle = {
            key: statistics.median(run["seconds"][key] for run in group)
            for key in [*PHASES, "solve", "total", "wall"]
        }
        rows.append({
            "kind": kind,
            "ranks": ranks,
            "threads": group[0]["threads"],
            **{key: group[0][key] for key in ("dofs", "subdomains", "interface_dofs", "contact_conditions")},
            "repetitions": len(group),
            **{key: round(value, 6) for key, value in middle.items()},
            "bytes_sent": round(statistics.median(map(sum, sent))) if known else "",
            "bytes_sent_by_largest": round(statistics.median(map(max, sent))) if known else "",
            **modelled(group),
            "peak_memory_of_largest": max(rank["peak_memory_bytes"] for run in group for rank in run["per_rank"]),
            "peak_memory_bytes": max(run["peak_memory_bytes"] for run in group),
        })
    for row in rows:
        first = next(other for other in rows if other["kind"] == row["kind"])
        for key in ("solve", "total", "modelled_total"):
            if row[key] == "":
                continue
            ideal = first[key]
            if row["kind"] == "strong":
                ideal *= first["ranks"] / row["ranks"]
            row[f"efficiency_{key}"] = round(ideal / row[key], 4)
    return rows


def write_csv(rows, path):
    with open(path, "w", newline="") as file:
        names = list(dict.fromkeys(name for row in rows for name in row))
        writer = csv.DictWriter(file, names, lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)
    print(path)


def draw(rows, path):
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    plt.rcParams.update({"svg.fonttype": "none", "svg.hashsalt": "scaling", "font.size": 11})
    kinds = [kind for kind in ("strong", "weak") if any(row["kind"] == kind for row in rows)]
    figure, panels = plt.subplots(
        1, len(kinds), figsize=(4.4 * len(kinds), 4.2), layout="constrained", squeeze=False
    )
    for kind, axes in zip(kinds, panels[0]):
        own = [row for row in rows if row["kind"] == kind]
        first, places = own[0], np.arange(len(own))
        below = np.zeros(len(own))
        for phase in PHASES:
            values = np.array([row[phase] for row in own])
            axes.bar(places, values, 0.6, below, color=COLORS[phase], label=phase)
            below += values
        power = 1 if kind == "strong" else 0
        ideal = [first["total"] * (first["ranks"] / row["ranks"]) ** power for row in own]
        axes.hlines(ideal, places - 0.4, places + 0.4, "k", "--", lw=1.2, label="ideal, of the total")
        # The total isn't the sum: each phase is that of its slowest rank, and something lies between them.
        for place, row in zip(places, own):
            axes.annotate(f"total {row['total']:.3g} s", (place, max(below[place], ideal[place])), xytext=(0, 3),
                          textcoords="offset points", ha="center", va="bottom")
        share = "in all" if kind == "strong" else f"on {first['ranks']} rank" + "s" * (first["ranks"] > 1)
        axes.set_title(f"{kind.capitalize()} scaling, {runs.name_of(first['dofs'])} dofs {share}", fontsize=11)
        axes.set_xticks(places, [str(row["ranks"]) for row in own])
        axes.margins(y=0.12)
        axes.set_xlabel("ranks")
        axes.set_ylabel("time of the slowest rank [s]")
        axes.grid(axis="y", alpha=0.25, lw=0.5)
        axes.set_axisbelow(True)
        axes.spines[["top", "right"]].set_visible(False)
    handles, labels = panels[0][0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncol=4, frameon=False)
    figure.savefig(path, metadata={"Date": None})
    print(path)


def main():
    # Where nobody reads on, as behind `| head`, there is nothing more to do.
    signal.signal(signal.SIGPIPE, signal.SIG_DFL)
    arguments = options.scaling(sys.argv[1:])
    arguments.folder.mkdir(parents=True, exist_ok=True)

    if not arguments.collect:
        cores = len(os.sched_getaffinity(0))
        ranks = arguments.ranks or ranks_up_to(cores)
        kinds = [arguments.only] if arguments.only else ["strong", "weak"]
        if arguments.problem:
            kinds = ["strong"]
        for kind, count in ((kind, count) for kind in kinds for count in ranks):
            problem_of(kind, count, arguments)
        if arguments.prepare:
            return
        chosen = [arguments.repetition] if arguments.repetition else range(1, arguments.repeat + 1)
        # All of them in turn, so that a disturbance of the machine doesn't hit one number of ranks.
        for repetition in chosen:
            for kind in kinds:
                for count in ranks:
                    measure(kind, count, repetition, arguments)
    if arguments.repetition and not arguments.collect:
        return
    rows = collect(arguments.folder)
    write_csv(rows, arguments.folder / "scaling.csv")
    draw(rows, arguments.folder / "scaling.svg")
    print_model(rows, arguments.far)


main()
