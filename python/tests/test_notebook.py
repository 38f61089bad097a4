"""The notebook of the tutorials runs, and prints what it shows."""

import nbformat
from conftest import ROOT
from nbclient import NotebookClient


def printed(notebook):
    return [[output["text"] for output in cell.get("outputs", []) if "text" in output] for cell in notebook.cells]


def test_the_notebook_prints_what_it_shows(tmp_path, monkeypatch):
    monkeypatch.setenv("PYTHONPATH", str(ROOT / "python"))
    monkeypatch.delenv("MPLBACKEND", raising=False)
    shown = nbformat.read(ROOT / "docs/tutorials/python.ipynb", as_version=4)
    assert sum(map(len, printed(shown))) == 3
    run = nbformat.from_dict(shown)
    NotebookClient(run, timeout=120, resources={"metadata": {"path": tmp_path}}).execute()
    assert printed(run) == printed(shown)
    outputs = [output for cell in run.cells for output in cell.get("outputs", [])]
    assert sum("image/png" in output.get("data", {}) for output in outputs) == 1
