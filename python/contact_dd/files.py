"""Files that are whole: written beside, then put in the place of the one that may be there."""

from __future__ import annotations

import os
from pathlib import Path

from contact_dd.errors import OutputError


def write(path: Path, content: str | bytes) -> None:
    """Writes a file, with its folder where that isn't there; one that is there stays as it is until the new one is
    whole. Raises `OutputError`."""
    # Behind a link is the file that is meant.
    target = path.resolve()
    beside = target.with_name(f".contact-dd-{os.getpid()}.part")
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        try:
            with beside.open("wb") as file:
                file.write(content.encode() if isinstance(content, str) else content)
                file.flush()
                os.fsync(file.fileno())
            beside.replace(target)
        finally:
            beside.unlink(missing_ok=True)
    except OSError as error:
        raise OutputError(f"{path}: can't be written: {error.strerror}") from error
