"""The options of scripts/bench and scripts/scaling. They are looked at before anything is installed or built: run by itself
with the name of one of the functions and its options this file ends with 2 where these are wrong.
"""

import argparse
import pathlib
import sys

import runs

# Walls of bricks: bricks in the length, courses, cells in the height of a brick.
WALLS = {"wall": (10, 6, 30), "many": (18, 20, 18)}


def listed(kind):
    """What reads things of a kind, by commas."""
    def read(text):
        return [kind(word) for word in text.split(",") if word]

    # Its name in messages of argparse.
    read.__name__ = "list, by commas"
    return read


def wall_name(text):
    """The name of a wall."""
    if text not in WALLS:
        raise argparse.ArgumentTypeError(f"there is no wall '{text}'; expected {', '.join(WALLS)}")
    return text


def bench(words):
    """The options of scripts/bench in the plane."""
    parser = argparse.ArgumentParser(prog="bench", description="Measures contact-dd-mpi against PARDISO and CHOLMOD, and on walls of bricks.")
    parser.add_argument("--sizes", metavar="DOFS", type=listed(runs.count), help="dofs, by commas (default: 5k,80k,500k,2M)")
    parser.add_argument("--walls", type=listed(wall_name),
                        help="walls of bricks, '' for none (default: all, none where --sizes says what to measure)")
    parser.add_argument("--repeat", type=int, default=5, help="repetitions (default: %(default)s)")
    parser.add_argument("--subdomains", type=int, help="of the problem (default: what suits the size)")
    parser.add_argument("--programs", type=pathlib.Path, default=runs.default_programs(),
                        help="folder of the two programs, which are then not built")
    parser.add_argument("--markdown", action="store_true", help="tables in Markdown")
    parser.add_argument("--tables", type=pathlib.Path, metavar="FILE",
                        help="measures nothing, prints the tables of an earlier measurements.json")
    arguments = parser.parse_args(words)
    if arguments.walls is None:
        arguments.walls = list(WALLS) if arguments.sizes is None else []
    if arguments.sizes is None:
        arguments.sizes = [runs.count(size) for size in ("5k", "80k", "500k", "2M")]
    return arguments


def space(words):
    """Those of scripts/bench --dim 3."""
    parser = argparse.ArgumentParser(prog="bench --dim 3", description="Measures contact-dd-mpi in space against conjugate gradients with GAMG.")
    parser.add_argument("--dim", type=int, choices=[3], help="what chooses this")
    parser.add_argument("--cells", type=listed(int), default="24,40", help="along an edge, by commas (default: %(default)s; 68 make a million dofs)")
    parser.add_argument("--repeat", type=int, default=3, help="repetitions (default: %(default)s)")
    parser.add_argument("--programs", type=pathlib.Path, default=runs.default_programs(),
                        help="folder of the two programs, which are then not built")
    return parser.parse_args(words)


def scaling(words):
    """Those of scripts/scaling."""
    parser = argparse.ArgumentParser(prog="scaling", description="Strong and weak scaling of contact-dd-mpi.")
    parser.add_argument("folder", type=pathlib.Path, help="for reports/, scaling.csv and scaling.svg")
    parser.add_argument("--ranks", type=listed(int), help="numbers of ranks, by commas (default: 1, 2, 4, ... all cores)")
    parser.add_argument("--strong", type=runs.count, default=500_000, metavar="DOFS",
                        help="dofs of the fixed problem (default: 500k)")
    parser.add_argument("--weak", type=runs.count, default=250_000, metavar="DOFS",
                        help="dofs for each rank (default: 250k)")
    parser.add_argument("--only", choices=["strong", "weak"], help="only this kind")
    parser.add_argument("--scene", choices=sorted(runs.SCENES), default="granite",
                        help="the granite block in the plane or two boxes in space (default: %(default)s)")
    parser.add_argument("--friction", type=float, help="coefficient of friction of its contacts (default: none)")
    parser.add_argument("--repeat", type=int, default=5, help="repetitions (default: %(default)s)")
    parser.add_argument("--repetition", type=int, help="only this one of them, for a job of an array")
    parser.add_argument("--interface", choices=["direct", "iterative"], help="of contact-dd-mpi (default: its choice)")
    parser.add_argument("--far", type=listed(int), default="1024,4096", help="ranks for which times are fitted (default: %(default)s)")
    parser.add_argument("--threads", type=int, default=1, help="of each rank (default: 1)")
    parser.add_argument("--subdomains", type=int, help="of the fixed problem (default: what suits its size)")
    parser.add_argument("--subdomains-per-rank", type=int, help="of the growing one (default: likewise)")
    parser.add_argument("--problem", type=pathlib.Path, help="problem file for strong scaling, nothing else")
    parser.add_argument("--programs", type=pathlib.Path, default=runs.default_programs(),
                        help="folder of the two programs, which are then not built")
    parser.add_argument("--prepare", action="store_true", help="makes the problem files, runs nothing")
    parser.add_argument("--collect", action="store_true", help="runs nothing, makes CSV and SVG of the reports")
    return parser.parse_args(words)


if __name__ == "__main__":
    {"bench": bench, "space": space, "scaling": scaling}[sys.argv[1]](sys.argv[2:])
