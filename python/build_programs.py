"""Builds contact-dd-partition and contact-dd-mpi, which become scripts of the wheel.

What is missing for that is said by its Debian packages; cargo's progress is shown on the terminal. Where
CONTACT_DD_BIN names a folder of built programs, or for an editable installation, the wheel is pure Python.
"""

from __future__ import annotations

import os
import subprocess
import sysconfig
from contextlib import ExitStack
from pathlib import Path
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface

NAMES = ["contact-dd-partition", "contact-dd-mpi"]

BUILD = """
source scripts/environment
cargo build --release --workspace --bins >&2
scripts/licences >"${CARGO_TARGET_DIR:-$PWD/target}/licences.txt"
printf '%s' "${CARGO_TARGET_DIR:-$PWD/target}"
"""


class Programs(BuildHookInterface[Any]):
    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        if version == "editable" or os.environ.get("CONTACT_DD_BIN"):
            return
        repository = Path(self.root).parent
        check = subprocess.run([repository / "scripts/setup", "--check"], stderr=subprocess.PIPE, text=True)
        if check.returncode != 0:
            raise SystemExit(
                f"the programs can't be built: {check.stderr.strip()}; scripts/setup installs it. For programs that "
                "are built already name their folder in CONTACT_DD_BIN"
            )
        with ExitStack() as stack:
            try:
                # pip hides the output of a build; as this takes minutes, it is shown on the terminal.
                progress = stack.enter_context(open("/dev/tty", "w"))
            except OSError:
                progress = None
            command = ["bash", "-euc", BUILD]
            built = subprocess.run(
                command, cwd=repository, check=False, stdout=subprocess.PIPE, stderr=progress, text=True
            )
        if built.returncode != 0:
            raise SystemExit(
                f"the programs can't be built: cargo ended with {built.returncode}; what it said stands above"
            )
        build_data["shared_scripts"] = {f"{built.stdout}/release/{name}": name for name in NAMES}
        texts = [f"{built.stdout}/licences.txt", *map(str, repository.glob("LICENSE-*"))]
        build_data["shared_data"] = {text: f"share/doc/contact-dd/{Path(text).name}" for text in texts}
        build_data["pure_python"] = False
        build_data["tag"] = "py3-none-" + sysconfig.get_platform().replace("-", "_").replace(".", "_")
