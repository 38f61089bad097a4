"""The two programs: their paths, runs and messages."""

from __future__ import annotations

import contextlib
import json
import operator
import os
import re
import shutil
import subprocess
import sysconfig
import tempfile
import warnings
from collections.abc import Callable, Collection, Sequence
from pathlib import Path
from typing import Any

from contact_dd import errors, files
from contact_dd import study as studies
from contact_dd.result import Result
from contact_dd.study import Study

Progress = bool | Callable[[dict[str, Any]], None]
Worded = Callable[[str], str]

# The name of its explanation behind a message.
NAMED = re.compile(r" \[--explain [\w-]+\]$")

# OpenMPI starts neither as root nor with more ranks than cores by default; a call that names ranks permits it.
ENVIRONMENT = {
    "OMPI_ALLOW_RUN_AS_ROOT": "1",
    "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
    "OMPI_MCA_rmaps_base_oversubscribe": "1",
}


def find(name: str) -> str:
    """A program: in the folder CONTACT_DD_BIN, among the scripts of this Python, on the path."""
    places = [os.environ.get("CONTACT_DD_BIN", ""), sysconfig.get_path("scripts"), os.environ.get("PATH", "")]
    found = shutil.which(name, path=os.pathsep.join(place for place in places if place))
    if found is None:
        raise errors.ContactError(
            f"there is no {name}: install the package where MPI, HDF5 and Rust are, put the program on the path, or "
            "name its folder in CONTACT_DD_BIN"
        )
    return found


def launcher(ranks: int) -> list[str]:
    """Launcher of `ranks` processes: MPIEXEC or mpirun; none for one."""
    try:
        enough = operator.index(ranks) >= 1
    except TypeError:
        enough = False
    if not enough:
        raise errors.InputError(f"ranks={ranks!r}; expected a whole number, 1 or more")
    if ranks == 1:
        return []
    named = os.environ.get("MPIEXEC") or "mpirun"
    found = shutil.which(named)
    if found is None:
        raise errors.ContactError(
            f"there is no {named} to start {ranks} ranks: expected that of the MPI which contact-dd-mpi is built with "
            "on the path or in MPIEXEC; ranks=1 needs none"
        )
    return [found, "-n", str(ranks)]


def partition(
    scene: Path, subdomains: int | None, progress: Progress, worded: Worded = str, problem: Path | None = None,
    prints: Path | None = None, warned: set[str] | None = None,
) -> Path:
    """Writes the problem file of a scene or a deck, by default beside it, and the tables requested by the deck into
    `prints`. Messages are `worded`; warnings are added to those `warned`, as the file has them, too."""
    problem = problem or scene.with_suffix(".h5")
    number = [] if subdomains is None else ["-n", str(subdomains)]
    number += [] if prints is None else ["--write-prints", str(prints)]

    def take_line(line: str) -> None:
        word, _, rest = line.partition(" ")
        if word == "warning":
            # The solver's warnings come without the name of their explanation.
            message = NAMED.sub("", rest.strip())
            if warned is not None:
                warned.add(message)
            warnings.warn(worded(message), stacklevel=6)
        elif progress is True and word in ("mesh", "contact"):
            print(line, flush=True)

    run([find("contact-dd-partition"), str(scene), "-o", str(problem), *number], take_line, worded)
    return problem


def convert(deck: Path, folder: Path) -> None:
    """Translates a deck into a scene and a mesh, and prints the program's messages."""
    run([find("contact-dd-partition"), str(deck), "--write-scene", str(folder)], print, str)


def solve(
    problem: Path, ranks: int, options: Sequence[str], progress: Progress, worded: Worded = str,
    warned: Collection[str] = (),
) -> Result:
    """Solves a problem file. Messages are `worded`; warnings that are `warned` aren't given again."""
    if isinstance(options, str):
        raise errors.InputError(f"options={options!r}; expected a list of them")
    output = problem.with_suffix(".vtkhdf")
    try:
        run_solver(problem, output, ranks, options, progress, worded, warned)
    except errors.NotConverged as error:
        error.result = Result(output)
        raise
    return Result(output)


def study(
    problem: Path, cases: dict[str, Any], ranks: int, options: Sequence[str], progress: Progress, worded: Worded = str,
    warned: Collection[str] = (),
) -> Study:
    """Solves the cases of a study. Messages are `worded`; warnings that are `warned` aren't given again."""
    asked, output = problem.with_suffix(".cases.json"), problem.with_suffix(".study.json")
    files.write(asked, json.dumps(cases))
    # The table shows the cases that don't converge.
    with contextlib.suppress(errors.NotConverged):
        run_solver(problem, output, ranks, ["--study", str(asked), *options], progress, worded, warned)
    return studies.read(output)


def run_solver(
    problem: Path, output: Path, ranks: int, options: Sequence[str], progress: Progress, worded: Worded,
    warned: Collection[str],
) -> None:
    """Runs the solver. Messages are `worded`; warnings that are `warned` aren't given again."""

    def take_line(line: str) -> None:
        event = event_of(line)
        if event is None:
            return
        if event["event"] == "warning" and event["message"] not in warned:
            warnings.warn(worded(event["message"]), stacklevel=6)
        if callable(progress):
            progress(event)
        elif progress:
            show(event)

    command = [*launcher(ranks), find("contact-dd-mpi"), str(problem), "-o", str(output), "--log", "json"]
    run([*command, *map(str, options)], take_line, worded)


def run(command: Sequence[str], take_line: Callable[[str], None], worded: Worded) -> None:
    """Runs a program, whose output `take_line` gets line by line. Raises its error, `worded`."""
    text: Any = {"encoding": "utf-8", "errors": "replace"}
    with tempfile.TemporaryFile("w+", **text) as printed:
        try:
            program = subprocess.Popen(
                command, stdout=subprocess.PIPE, stderr=printed, env={**ENVIRONMENT, **os.environ}, **text
            )
        except (OSError, ValueError) as error:
            raise errors.ContactError(f"{command[0]}: can't be started: {error}") from error
        with program:
            try:
                for line in program.stdout or ():
                    take_line(line.rstrip("\n"))
            except BaseException:
                program.terminate()
                raise
            if program.wait() != 0:
                printed.seek(0)
                raise error_of(program.returncode, printed.read(), worded)


def error_of(code: int, printed: str, worded: Worded) -> errors.ContactError:
    """The error of a program that ended with `code`: the message of its event, or all of its output."""
    for line in printed.splitlines():
        event = event_of(line)
        if event is not None and event["event"] == "error":
            return errors.by_exit_code(event["exit_code"], worded(event["message"]))
    return errors.by_exit_code(code, worded(printed.strip().removeprefix("error: ")))


def event_of(line: str) -> dict[str, Any] | None:
    """An event of `--log json`; None for lines of launchers and libraries."""
    if not line.startswith('{"event":'):
        return None
    event: dict[str, Any] = json.loads(line)
    return event


def show(event: dict[str, Any]) -> None:
    """Prints a line for an event of interest to users."""
    match event:
        case {"event": "problem", "dofs": dofs, "ranks": ranks}:
            print(f"{dofs} degrees of freedom, {ranks} rank{'s' * (ranks > 1)}", flush=True)
        case {"event": "phase", "phase": phase, "seconds": seconds}:
            print(f"{seconds:8.2f} s  {phase}", flush=True)
        case {"event": "progress", "phase": phase, "done": done, "seconds": seconds, "seconds_left": left}:
            print(f"{seconds:8.2f} s  {phase}, {done:.0%}, about {left:.0f} s left", flush=True)
        case {"event": "step", "step": step, "steps": steps, "name": name}:
            print(f"step {step} of {steps}: {name}", flush=True)
        case {"event": "sweep", "sweep": sweep, "residual": residual, "active": active}:
            print(f"            sweep {sweep}: residual {residual:.1e}, {active} closed", flush=True)
        case {"event": "finished", "reason": reason}:
            print(reason, flush=True)
