"""Problems of a wanted size, and runs of the two programs."""

import datetime
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


def measured():
    """Date and commit of a measured page, in the words of all of them."""
    describe = ["git", "describe", "--always", "--dirty", "--exclude=*", "--abbrev=8"]
    commit = subprocess.run(describe, cwd=ROOT, capture_output=True, text=True).stdout.strip()
    return f"Measured on {datetime.date.today()} at commit {commit or 'unknown'}"


def say(text):
    print(text, file=sys.stderr, flush=True)


def default_programs():
    return pathlib.Path(os.environ.get("CARGO_TARGET_DIR") or ROOT / "target") / "release"


def call(command):
    """Runs a command; where it fails, says what it printed and ends."""
    ran = subprocess.run([str(word) for word in command], capture_output=True, text=True)
    if ran.returncode != 0:
        sys.exit(f"{shlex.join(map(str, command))}\n{ran.stdout}{ran.stderr}exit code {ran.returncode}")
    return ran.stdout


def granite(dofs):
    """The granite block with about `dofs` dofs, a scene that stays for the next time."""
    scene = FOLDER / "meshes" / f"granite-{dofs}.toml"
    if not scene.exists():
        say(f"meshing the granite block with {name_of(dofs)} dofs")
        call([sys.executable, ROOT / "scripts" / "performance" / "granite.py", dofs, scene.parent])
    return scene


def two_boxes(dofs):
    """Two boxes of tetrahedra with about `dofs` dofs, a scene that stays for the next time."""
    cells = min(range(2, 1000, 2), key=lambda cells: abs(3 * (cells + 1) ** 2 * (cells + 2) - dofs))
    scene = FOLDER / "meshes" / f"boxes-{cells}.toml"
    if not scene.exists():
        say(f"meshing two boxes with {name_of(dofs)} dofs")
        call([sys.executable, ROOT / "scripts" / "performance" / "boxes.py", cells, scene.parent])
    return scene


SCENES = {"granite": granite, "boxes": two_boxes}


def with_friction(scene, friction):
    """The scene with this coefficient of friction in all contacts."""
    path = scene.with_stem(f"{scene.stem}-friction-{friction}")
    path.write_text(scene.read_text().replace("[[contact]]", f"[[contact]]\nfriction = {friction}"))
    return path


def problem(dofs, programs, subdomains=None, scene="granite", friction=None):
    """A scene of these with about `dofs` dofs as a problem file."""
    made = SCENES[scene](dofs)
    return partitioned(with_friction(made, friction) if friction else made, programs, subdomains)


def partitioned(scene, programs, subdomains=None):
    """A scene as a problem file, which is written anew when contact-dd-partition is newer."""
    path = FOLDER / "problems" / f"{scene.stem}{f'-n{subdomains}' if subdomains else ''}.h5"
    tool = programs / "contact-dd-partition"
    if not path.exists() or path.stat().st_mtime < tool.stat().st_mtime:
        say(f"partitioning {scene.stem} into {subdomains or 'a number of'} subdomains")
        partition(scene, path, programs, subdomains)
    return path


def partition(scene, path, programs, subdomains=None):
    """Writes a problem file; the seconds from the start of contact-dd-partition to its end."""
    path.parent.mkdir(parents=True, exist_ok=True)
    options = ["-n", subdomains] if subdomains else []
    start = time.perf_counter()
    call([programs / "contact-dd-partition", scene, *options, "-o", path])
    return time.perf_counter() - start


def flops(path, programs):
    """What --check says a run takes, in flops."""
    checked = call([programs / "contact-dd-mpi", "--check", path])
    return 1e9 * float(checked.split("arithmetic")[1].split()[0])


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
