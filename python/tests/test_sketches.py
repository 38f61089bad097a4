"""Sketches of the validation: every case has one, drawn as the script draws it now."""

import importlib
import re
import sys
import xml.etree.ElementTree as ElementTree

import matplotlib.pyplot as plt
import numpy as np
import pytest
from conftest import ROOT

LARGEST = 300_000


@pytest.fixture(scope="module")
def sketches():
    sys.path.insert(0, str(ROOT / "scripts/performance"))
    yield importlib.import_module("sketches")
    sys.path.pop(0)


def test_every_case_has_a_sketch_on_its_page(sketches):
    chapters = (ROOT / "docs/validation.md").read_text().split("\n## ")[1:]
    cases = {chapter.partition("\n")[0]: chapter for chapter in chapters if "\n| cells | dofs" in chapter}
    assert set(cases) == set(sketches.CASES)
    for title, chapter in cases.items():
        name, *curve = re.findall(r"!\[[^\]]*\]\((figures/validation/[^)]*\.svg)\)", chapter)
        assert name == f"figures/validation/{sketches.anchor_of(title)}.svg"
        # Errors that are round-off on all meshes have no curve.
        assert curve == [name.replace(".svg", "-errors.svg")] * len(curve), title
        assert len(curve) == (0 if title.startswith(("Patch test", "Junction")) else 1)
        path = ROOT / "docs" / name
        assert path.stat().st_size < LARGEST
        words = {text.text for text in ElementTree.parse(path).iter("{http://www.w3.org/2000/svg}text")}
        # What the legend says is text, and a file is what the script draws of its case.
        if title in sketches.DRAWN:
            drawn = sketches.DRAWN[title]()
            assert set(drawn.named) <= words, title
            plt.close(drawn.figure)


def test_a_scene_is_drawn_with_its_contacts_and_supports(sketches):
    drawn = sketches.of_scene("plain")
    assert set(drawn.named) == {"roller, held along its axis", "load"}
    [body] = drawn.axes.patches
    # A quarter of a plate with a hole: what the path encloses is what the cells do.
    x, y = body.get_path().vertices.T
    assert len(body.get_path().to_polygons()) == 1
    area = np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y) / 2
    corner = max(x.max(), y.max())
    hole = min(x[y < 1e-9 * corner])
    assert np.isclose(area, x.max() * y.max() - np.pi * hole**2 / 4, rtol=1e-3)
    junction = sketches.of_scene("junction")
    assert "contact" in junction.named
    plt.close("all")
