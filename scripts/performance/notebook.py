"""The outputs of a notebook, made anew; run it by scripts/notebook.

    notebook.py NOTEBOOK
"""

import base64
import io
import sys
import tempfile

import nbformat
from contact_dd.drawing.canvas import with_palette
from nbclient import NotebookClient
from PIL import Image


def small(picture):
    """A PNG with a palette, in base64, of such a PNG."""
    image = Image.open(io.BytesIO(base64.b64decode(picture))).convert("RGB")
    found = io.BytesIO()
    with_palette(image).save(found, "PNG", optimize=True)
    return base64.b64encode(found.getvalue()).decode()


def main():
    path = sys.argv[1]
    notebook = nbformat.read(path, as_version=4)
    metadata = nbformat.from_dict(notebook.metadata)
    with tempfile.TemporaryDirectory() as folder:
        client = NotebookClient(notebook, timeout=300, record_timing=False, resources={"metadata": {"path": folder}})
        client.execute()
    notebook.metadata = metadata
    for cell in notebook.cells:
        for output in cell.get("outputs", []):
            if "image/png" in output.get("data", {}):
                output.data["image/png"] = small(output.data["image/png"])
    nbformat.write(notebook, path)


main()
