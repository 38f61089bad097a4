"""The folder of a model: its scene and mesh, of which only those are written over that were written here."""

from __future__ import annotations

import hashlib
import re
from pathlib import Path

from contact_dd import files
from contact_dd.errors import InputError, OutputError

# The first line of a scene that is written here: the digests of what follows and of the mesh that came with it.
MARK = re.compile(r"# written by contact_dd, (\w+); mesh\.msh (\w+)\n")
NO_MESH = "none"


def write(folder: Path, scene: str, mesh: bytes | None) -> Path:
    """Writes `scene.toml`, and with a mesh `mesh.msh`; returns the path of the scene.

    Raises `InputError` where one of them is there and others have written or changed it since, `OutputError` where
    they can't be written."""
    at_scene, at_mesh = folder / "scene.toml", folder / "mesh.msh"
    written = of_mesh = ""
    before = content(at_scene)
    if before is not None:
        found = MARK.match(text := before.decode(errors="replace"))
        if found is None or found[1] != digest(text[found.end() :].encode()):
            raise InputError(
                f"{at_scene}: is there already, and wasn't written by contact_dd or was changed since; "
                "expected another folder"
            )
        written = found[2]
    if mesh is not None:
        of_mesh = digest(mesh)
        there = content(at_mesh)
        if there is None or digest(there) == written:
            files.write(at_mesh, mesh)
        elif there == mesh:
            # It is somebody's, and stays that.
            of_mesh = NO_MESH
        else:
            raise InputError(f"{at_mesh}: is another mesh, not written by contact_dd; expected another folder")
    files.write(at_scene, f"# written by contact_dd, {digest(scene.encode())}; mesh.msh {of_mesh or NO_MESH}\n{scene}")
    return at_scene


def content(path: Path) -> bytes | None:
    """Contents of an existing file that is to be written."""
    try:
        return path.read_bytes()
    except FileNotFoundError:
        return None
    except OSError as error:
        raise OutputError(f"{path}: can't be written: {error.strerror}") from error


def digest(data: bytes) -> str:
    return hashlib.sha256(data).hexdigest()[:16]
