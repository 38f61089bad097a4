"""The command `contact-dd`: runs of decks and scenes, pictures, pages and tables of results, error bars, and adaptive
refinement."""

import argparse
import io
import json
import signal
import sys
import tempfile
import warnings
from pathlib import Path

import matplotlib

from contact_dd import files, programs
from contact_dd.adaptivity import adapt as solve_adapted
from contact_dd.comparison import Compared, compare
from contact_dd.dat import write_dat
from contact_dd.errors import ContactError, InputError, OutputError
from contact_dd.manual import KINDS, Generate, version
from contact_dd.model import Model, scene_of
from contact_dd.result import Result
from contact_dd.study import cases_of, values_of
from contact_dd.tables import write_tables


def main() -> None:
    # A closed pipe, as behind `| head`, is no error.
    signal.signal(signal.SIGPIPE, signal.SIG_DFL)
    warnings.showwarning = lambda message, *_: print(f"warning: {message}", file=sys.stderr)
    matplotlib.use("Agg")
    arguments = parser().parse_args()
    try:
        arguments.command(arguments)
    except ContactError as error:
        print(f"error: {error}", file=sys.stderr)
        sys.exit(error.exit_code)


def parser() -> argparse.ArgumentParser:
    what = "Runs decks and scenes, draws and reports results of contact-dd-mpi, and adapts meshes."
    top = argparse.ArgumentParser(prog="contact-dd", description=what)
    top.add_argument("-V", "--version", action="version", version=f"contact-dd {version()}", help="print the version")
    top.add_argument(
        "--generate", action=Generate, choices=KINDS, metavar="KIND",
        help="print the man page or completions for a shell: " + ", ".join(KINDS),
    )
    commands = top.add_subparsers(required=True, metavar="COMMAND")

    what = "Partitions and solves a deck of Abaqus or CalculiX, or a scene, and writes the result."
    solved = commands.add_parser("run", help="solve a deck or a scene", description=what)
    solved.add_argument("source", type=Path, metavar="DECK.inp|SCENE.toml", help="deck or scene")
    solved.add_argument("--ranks", type=int, default=2, help="number of processes (default: 2)")
    solved.add_argument("--subdomains", type=int, help="number of subdomains (default: by size)")
    solved.add_argument("--folder", type=Path, default=Path(), help="folder for the files (default: the current one)")
    solved.set_defaults(command=run)

    what = "Solves a scene for many values of loads, gaps and friction by one factorization; writes tables."
    studied = commands.add_parser("study", help="solve for many values of parameters", description=what)
    studied.add_argument("source", type=Path, metavar="DECK.inp|SCENE.toml", help="deck or scene with [[quantity]]")
    studied.add_argument(
        "--vary", action="append", required=True, metavar="NAME=VALUES",
        help="a parameter, or a part of its name, and its values: first:last:step, or with commas between them; "
        "repeated: all combinations",
    )
    studied.add_argument("--ranks", type=int, default=2, help="number of processes (default: 2)")
    studied.add_argument("--subdomains", type=int, help="number of subdomains (default: by size)")
    studied.add_argument("--folder", type=Path, default=Path(), help="folder for the files (default: the current one)")
    studied.set_defaults(command=study)

    what = "Translates a deck of Abaqus or CalculiX into a scene and its mesh."
    converted = commands.add_parser("convert", help="translate a deck into a scene", description=what)
    converted.add_argument("deck", type=Path, metavar="DECK.inp", help="deck")
    converted.add_argument("folder", type=Path, nargs="?", help="folder to write (default: the deck's stem)")
    converted.set_defaults(command=convert)

    drawn = commands.add_parser("plot", help="draw pictures of a result", description="Draws pictures of a result.")
    drawn.add_argument("result", type=Path, help="result file of contact-dd-mpi")
    drawn.add_argument("outdir", type=Path, nargs="?", help="folder (default: figures beside the result)")
    drawn.add_argument(
        "--scale", type=factor, default="auto",
        help="enlargement of the deformation (default: auto: closed contacts don't seem to overlap)",
    )
    drawn.add_argument(
        "--circle", type=radius, metavar="RADIUS",
        help="in space: radius, in the scene's unit of length, of a dashed circle around the origin of pressure maps, "
        "such as that of Hertz's contact",
    )
    drawn.add_argument("--only", nargs="+", metavar="PICTURE", help="names of the pictures to draw (default: all)")
    drawn.add_argument("--step", type=int, help="number of the load step, from 1 (default: the last)")
    drawn.set_defaults(command=plot)

    written = commands.add_parser("report", help="write a page on a run", description="Writes a page in HTML.")
    written.add_argument("result", type=Path, help="result file of contact-dd-mpi")
    written.add_argument("page", type=Path, nargs="?", help="HTML file (default: the result's name with .html)")
    written.add_argument(
        "--coarser", type=Path, nargs="+", metavar="RESULT", help="results on coarser meshes, for error bars"
    )
    written.set_defaults(command=report)

    what = "Writes a CSV table of each contact: pressures and gaps, in the plane over the arc length."
    tabled = commands.add_parser("table", help="write tables of contacts", description=what)
    tabled.add_argument("result", type=Path, help="result file of contact-dd-mpi")
    tabled.add_argument("outdir", type=Path, nargs="?", help="folder (default: tables beside the result)")
    tabled.add_argument("--step", type=int, help="number of the load step, from 1 (default: the last)")
    tabled.set_defaults(command=table)

    what = "Compares results of one scene on two or three meshes, and estimates error bars."
    compared = commands.add_parser("compare", help="error bars from several meshes", description=what)
    compared.add_argument("results", type=Path, nargs="+", metavar="RESULT", help="result, each on another mesh")
    compared.set_defaults(command=bars)

    what = "Meshes and solves until the estimated error is as small as requested."
    adapted = commands.add_parser("adapt", help="mesh and solve until the error is small", description=what)
    adapted.add_argument("scene", type=Path, help="scene.toml")
    adapted.add_argument("--error", type=float, required=True, help="relative error, in the energy norm: 1e-2 is 1 %%")
    adapted.add_argument("--quantity", metavar="NAME", help="request the error of this quantity instead")
    adapted.add_argument("--geometry", type=Path, help="file that Gmsh meshes (default: the scene's mesh with .geo)")
    adapted.add_argument("--ranks", type=int, default=2, help="number of processes (default: 2)")
    adapted.add_argument("--folder", type=Path, help="folder of mesh and result (default: the scene's stem + -adapted)")
    adapted.set_defaults(command=adapt)
    return top


def factor(text: str) -> float | None:
    if text == "auto":
        return None
    return above_zero(text, f"'{text}' is no enlargement; expected 'auto' or a number above 0")


def radius(text: str) -> float:
    return above_zero(text, f"'{text}' is no radius; expected a number above 0")


def above_zero(text: str, otherwise: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = 0.0
    if not 0 < value < float("inf"):
        raise argparse.ArgumentTypeError(otherwise)
    return value


def run(arguments: argparse.Namespace) -> None:
    warned: set[str] = set()
    if arguments.source.suffix.lower() != ".inp":
        print(programs.solve(partitioned(arguments, warned), arguments.ranks, (), True, warned=warned).path)
        return
    with tempfile.TemporaryDirectory(prefix="contact-dd-") as folder:
        prints = Path(folder) / "prints.json"
        result = programs.solve(partitioned(arguments, warned, prints), arguments.ranks, (), True, warned=warned)
        print(result.path)
        path = result.path.with_suffix(".dat")
        if write_dat(result, json.loads(prints.read_text(encoding="utf-8")), path):
            print(path)


def study(arguments: argparse.Namespace) -> None:
    vary = dict(map(values_of, arguments.vary))
    if len(vary) < len(arguments.vary):
        raise InputError("--vary: a name occurs twice; expected it once, with all of its values")
    warned: set[str] = set()
    problem = partitioned(arguments, warned)
    table = programs.study(problem, cases_of(problem, vary), arguments.ranks, (), True, warned=warned)
    for path, write in (
        (problem.with_suffix(".study.csv"), table.write_csv), (problem.with_suffix(".study.h5"), table.write_hdf5)
    ):
        write(path)
        print(path)
    picture = problem.with_suffix(".study.svg")
    drawn = io.StringIO()
    table.plot().savefig(drawn, format="svg", metadata={"Date": None})
    files.write(picture, drawn.getvalue())
    print(picture)


def partitioned(arguments: argparse.Namespace, warned: set[str], prints: Path | None = None) -> Path:
    """The problem file of a scene or a deck, in the requested folder, and a file of the tables that a deck requests.
    Warnings are added to those `warned`."""
    source, folder = arguments.source, arguments.folder
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise OutputError(f"{folder}: can't be made: {error.strerror}") from error
    problem: Path = folder / (source.stem + ".h5")
    return programs.partition(source, arguments.subdomains, True, problem=problem, prints=prints, warned=warned)


def convert(arguments: argparse.Namespace) -> None:
    programs.convert(arguments.deck, arguments.folder or Path(arguments.deck.stem))


def plot(arguments: argparse.Namespace) -> None:
    from contact_dd.drawing.canvas import save
    from contact_dd.drawing.pictures import draw

    outdir = arguments.outdir or arguments.result.parent / "figures"
    result = Result(arguments.result, arguments.step)
    for name, figure in draw(result, arguments.only, arguments.scale, arguments.circle):
        save(figure, outdir / f"{name}.png")


def report(arguments: argparse.Namespace) -> None:
    from contact_dd.drawing.page import page

    path = arguments.page or arguments.result.with_suffix(".html")
    if path.suffix not in (".html", ".htm"):
        # A second result is a likely slip, and would be overwritten.
        raise InputError(f"{path}: isn't the name of a page; expected one that ends in .html")
    text = page(Result(arguments.result), [Result(path) for path in arguments.coarser or ()])
    files.write(path, text)
    print(path)


def table(arguments: argparse.Namespace) -> None:
    result = Result(arguments.result, arguments.step)
    for path in write_tables(result, arguments.outdir or arguments.result.parent / "tables"):
        print(path)


def bars(arguments: argparse.Namespace) -> None:
    print_bars(compare([Result(path) for path in arguments.results]))


def print_bars(found: list[Compared]) -> None:
    for one in found:
        order = "" if one.order is None else f", order {one.order:.1f}"
        error, fault = f" ± {one.error or 0.0:.2g}", ""
        if one.error is None:
            error, fault = "", ", no error: it doesn't converge, as at a singularity or on meshes too coarse"
        on_others = ", ".join(f"{value:.6g}" for value in one.values[:-1])
        print(f"{one.name}: {one.values[-1]:.6g}{error} {one.unit}{fault} (coarser {on_others}{order})")


def adapt(arguments: argparse.Namespace) -> None:
    scene, mesh = scene_of(arguments.scene)
    geometry = arguments.geometry or mesh.with_suffix(".geo")
    folder = arguments.folder or arguments.scene.with_name(arguments.scene.stem + "-adapted")
    # A mesh is made first of all.
    model, quantity = Model(b"", scene), arguments.quantity
    result, rounds = solve_adapted(
        model, arguments.error, geometry, quantity=quantity, ranks=arguments.ranks, folder=folder
    )
    try:
        print_bars(compare([one.result for one in rounds], adapted=True))
    except InputError:
        print("one mesh was enough, so that there are no error bars of pressures and forces")
    print(result.path)
