"""Problems of a wanted size, and runs of the two programs."""

import json
import os
import pathlib
import shlex
import subprocess
import sys
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
FOLDER = ROOT / "target" / "bench"
PHASES = ["read", "assemble", "factorize", "interface", "sweeps", "recover", "write"]
# From the mesh in memory to the solution in memory, what a library of linear algebra is given to do
# and more: assembly, stresses and the certificate.
SOLVE_PHASES = PHASES[1:6]


def count(text):
    """A number with k or M behind it."""
    factor = {"k": 1e3, "M": 1e6}.get(text[-1:], 1)
    return round(float(text.rstrip("kM")) * factor)


def name_of(dofs):
    for factor, letter in ((1_000_000, "M"), (1_000, "k")):
        if dofs >= factor:
            return f"{float(f'{dofs / factor:.3g}'):g}{letter}"
    return str(dofs)


def say(text):
    print(text, file=sys.stderr, flush=True)


def default_programs():
    return pathlib.Path(os.environ.get("CARGO_TARGET_DIR") or ROOT / "target") / "release"


def call(command):
    """Runs a command; where it fails, says what it said and ends."""
    ran = subprocess.run([str(word) for word in command], capture_output=True, text=True)
    if ran.returncode != 0:
        sys.exit(f"{shlex.join(map(str, command))}\n{ran.stdout}{ran.stderr}exit code {ran.returncode}")
    return ran.stdout


def problem(dofs, programs, subdomains=None):
    """The granite block with about `dofs` dofs as a problem file. Mesh and file stay for the next
    time; the file is written anew when contact-dd-partition is newer."""
    mesh = FOLDER / "meshes" / f"granite-{dofs}.msh"
    if not mesh.with_suffix(".toml").exists():
        say(f"meshing the granite block with {name_of(dofs)} dofs")
        call([sys.executable, ROOT / "scripts" / "performance" / "granite.py", dofs, mesh.parent])
    suffix = f"-n{subdomains}" if subdomains else ""
    path = FOLDER / "problems" / f"granite-{dofs}{suffix}.h5"
    partition = programs / "contact-dd-partition"
    if not path.exists() or path.stat().st_mtime < partition.stat().st_mtime:
        say(f"partitioning it into {subdomains or 'a number of'} subdomains")
        path.parent.mkdir(parents=True, exist_ok=True)
        options = ["-n", subdomains] if subdomains else []
        call([partition, mesh.with_suffix(".toml"), *options, "-o", path])
    return path


def solve(path, ranks, programs, result, options=()):
    """One run of contact-dd-mpi, as a user starts it: its report, with `wall`, the seconds from the
    launcher's start to its end."""
    report = result.with_suffix(".json")
    launcher = shlex.split(os.environ.get("MPIEXEC", "mpirun"))
    command = [*launcher, "-n", ranks, programs / "contact-dd-mpi", path, "-o", result]
    result.parent.mkdir(parents=True, exist_ok=True)
    start = time.perf_counter()
    call([*command, "--report", report, "--quiet", *options])
    wall = time.perf_counter() - start
    run = json.loads(report.read_text())
    report.unlink()
    run["seconds"]["wall"] = wall
    run["seconds"]["solve"] = max(
        sum(rank[phase] for phase in SOLVE_PHASES) for rank in run["per_rank"]
    )
    return run


def machine():
    """Processor, cores and system of this machine, in words."""
    model = "unknown processor"
    try:
        lines = pathlib.Path("/proc/cpuinfo").read_text().splitlines()
        model = next(line.split(":")[1].strip() for line in lines if line.startswith("model name"))
    except (OSError, StopIteration):
        pass
    cores = len(os.sched_getaffinity(0))
    return f"{model}, {cores} cores, load {os.getloadavg()[0]:.1f} at the start"
