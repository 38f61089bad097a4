"""The programs that an installation builds."""

import os
import pty
import subprocess
import sys
from pathlib import Path

import pytest

PACKAGE = Path(__file__).resolve().parents[1]

# Stands for hatchling, and calls the hook as it does; what is printed goes nowhere, as under pip.
CALL = """
import os, sys, types
nowhere = os.open(os.devnull, os.O_WRONLY)
os.dup2(nowhere, 1)
os.dup2(nowhere, 2)
class Interface:
    def __class_getitem__(cls, _): return cls
    root = sys.argv[1]
module = types.ModuleType("interface")
module.BuildHookInterface = Interface
for name in ("hatchling", "hatchling.builders", "hatchling.builders.hooks", "hatchling.builders.hooks.plugin"):
    sys.modules[name] = types.ModuleType(name)
sys.modules["hatchling.builders.hooks.plugin.interface"] = module
sys.path.insert(0, sys.argv[1])
import build_programs
data = {}
build_programs.Programs().initialize("standard", data)
assert len(data["shared_scripts"]) == 2
"""


@pytest.fixture
def repository(tmp_path, monkeypatch):
    """A repository whose Cargo ends with CARGO_ENDS and says how far it is."""
    files = {
        "python/build_programs.py": (PACKAGE / "build_programs.py").read_text(),
        "scripts/setup": "#!/bin/sh\n",
        "scripts/environment": "",
        "scripts/licences": "#!/bin/sh\n",
        "bin/cargo": "#!/bin/sh\necho Compiling faer >&2\nexit ${CARGO_ENDS:-0}\n",
        "target/licences.txt": "",
    }
    for name, text in files.items():
        path = tmp_path / name
        path.parent.mkdir(exist_ok=True)
        path.write_text(text)
        path.chmod(0o755)
    monkeypatch.setenv("PATH", f"{tmp_path / 'bin'}:{os.environ['PATH']}")
    monkeypatch.delenv("CARGO_TARGET_DIR", raising=False)
    monkeypatch.delenv("CONTACT_DD_BIN", raising=False)
    return tmp_path


def test_progress_is_shown_on_the_terminal_whatever_becomes_of_what_is_printed(repository):
    child, terminal = pty.fork()
    if child == 0:
        os.execv(sys.executable, [sys.executable, "-B", "-c", CALL, str(repository / "python")])
    shown = b""
    # At its end a terminal without a process is an error, not an empty read.
    while True:
        try:
            more = os.read(terminal, 1024)
        except OSError:
            break
        if not more:
            break
        shown += more
    _, status = os.waitpid(child, 0)
    assert os.waitstatus_to_exitcode(status) == 0
    assert b"Compiling faer" in shown


@pytest.mark.parametrize("ends", [0, 101])
def test_without_a_terminal_it_is_printed_and_a_failure_is_said(repository, monkeypatch, ends):
    monkeypatch.setenv("CARGO_ENDS", str(ends))
    # The first lines of CALL would hide it.
    call = CALL.replace("os.dup2(nowhere, 1)\nos.dup2(nowhere, 2)\n", "")
    command = [sys.executable, "-B", "-c", call, str(repository / "python")]
    # A session of its own has no terminal.
    ended = subprocess.run(command, capture_output=True, text=True, start_new_session=True)
    assert "Compiling faer" in ended.stderr
    assert ended.returncode == (1 if ends else 0)
    assert ("the programs can't be built: cargo ended with 101" in ended.stderr) == bool(ends)
