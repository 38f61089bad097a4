"""The view of a page, as a browser draws it, and the numbers in it."""

import base64
import json
import re
import shutil
import subprocess
import zlib

import numpy as np
import pytest

from contact_dd import Model
from contact_dd.drawing.page import page
from contact_dd.tables import write_tables

# Looks at what is drawn, asks for the next field, turns the bodies, and writes down what it saw.
LOOK = """<script>
const look = () => {
  const canvas = document.querySelector("#view canvas"), gl = canvas.getContext("webgl2");
  const pixels = new Uint32Array(canvas.width * canvas.height);
  gl.readPixels(0, 0, canvas.width, canvas.height, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(pixels.buffer));
  const colours = new Set(pixels);
  return [pixels.filter(pixel => pixel !== 0xffffffff).length / pixels.length, colours.size,
    pixels.reduce((sum, pixel) => (31 * sum + pixel) >>> 0, 0)];
};
setTimeout(() => {
  const canvas = document.querySelector("#view canvas"), field = document.querySelector("#view [name=field]");
  const seen = [look()];
  field.selectedIndex = field.options.length - 1;
  field.onchange();
  seen.push(look());
  const at = (kind, x, y) => canvas.dispatchEvent(new PointerEvent(kind, { pointerId: 1, clientX: x, clientY: y }));
  canvas.setPointerCapture = () => {};
  const { left, top, width, height } = canvas.getBoundingClientRect();
  at("pointermove", left + width / 2, top + height / 2);
  const here = document.querySelector("#view [name=here]").textContent;
  at("pointerdown", left + 100, top + 100);
  at("pointermove", left + 160, top + 120);
  seen.push(look());
  document.body.dataset.seen = JSON.stringify({ seen, here, drawn: canvas.dataset.drawn });
}, 2000);
</script>"""


@pytest.mark.parametrize("name", ["granite", "stack3d"])
def test_the_view_holds_the_result(scene, name):
    result = Model.from_scene(scene(name)).run(progress=False)
    text = page(result)
    assert len(result.title) > 5
    assert f"<h1>{result.title}<span" in text
    about, arrays = contents(text)
    points = arrays(about["points"]).reshape(-1, 3) * about["size"] + about["center"]
    rows = np.searchsorted(result.nodes, arrays(about["nodes"]))
    assert np.allclose(points, result.points[rows], atol=1e-6 * about["size"])
    a, b, c = (points[corner] for corner in arrays(about["surfaces"][0]["triangles"]).reshape(-1, 3).T)
    areas = np.cross(b - a, c - a) / 2
    if result.is_in_space:
        # The volume inside: they are closed and look outward.
        assert np.isclose((areas * a).sum() / 3, 29)
    else:
        assert np.allclose(areas[:, :2], 0)
        assert np.isclose(np.abs(areas[:, 2]).sum(), 100)
    [step] = about["steps"]
    displacement = arrays(step["displacements"]).reshape(-1, 3) * about["size"]
    assert np.allclose(displacement, result.displacement[rows], atol=1e-6 * np.abs(result.displacement).max())
    for field in step["fields"]:
        values = arrays(field["values"]) / 65535 * field["most"]
        assert np.isclose(values.max(), field["most"])
        if field["name"] == "contact pressure":
            pressure = max(table["pressure"].max() for table in result.contacts.values())
            assert np.isclose(field["largest"] * {"Pa": 1, "kPa": 1e3, "MPa": 1e6}[field["unit"]], pressure)


@pytest.mark.parametrize("name", ["mindlin", "sphere"])
def test_a_browser_draws_the_view(scene, name, tmp_path):
    text = page(Model.from_scene(scene(name)).run(progress=False))
    # Nothing is fetched.
    assert not re.search(r'(src|href)="(?!data:|#)', text)
    about, _ = contents(text)
    browser = shutil.which("chromium")
    assert browser, "there is no chromium; scripts/setup --documents installs it"
    path = tmp_path / "page.html"
    path.write_text(text.replace("</body>", LOOK + "</body>"))
    command = [browser, "--headless", "--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]
    command += [f"--user-data-dir={tmp_path / 'browser'}", "--virtual-time-budget=20000"]

    def run(*options):
        ended = subprocess.run(
            [*command, *options, path.as_uri()], check=True, capture_output=True, text=True, timeout=120
        )
        return ended.stdout

    printed = tmp_path / "page.pdf"
    run(f"--print-to-pdf={printed}")
    assert len(re.findall(rb"/Type\s*/Page\b", printed.read_bytes())) == 1
    drawn = run("--dump-dom")
    [found] = re.findall(r"data-seen=\"([^\"]*)\"", drawn)
    found = json.loads(found.replace("&quot;", '"'))
    shares, colours, sums = zip(*found["seen"])
    assert all(0.1 < share < 0.95 for share in shares), found
    assert colours[0] > 100, found
    assert len(set(sums)) == 3, found
    assert re.match(r"node \d+ at \(.*\) m+: \d", found["here"]), found
    shown = about["surfaces"][0]["sides" if name == "sphere" else "triangles"]
    assert int(found["drawn"]) == shown["length"] / 3


def test_what_isnt_there_isnt_drawn_and_what_came_lies_where_it_belongs(scene, tmp_path):
    last = Model.from_scene(scene("tunnel")).run(folder=tmp_path, progress=False)
    steps = [last.at_step(k) for k in range(1, 5)]
    assert [one.since for one in steps] == [0, 0, 2, 2]
    assert [list(one.contacts_there) for one in steps] == [["face"], [], ["extrados"], ["extrados"]]
    about, arrays = contents(page(last))
    points = arrays(about["points"]).reshape(-1, 3) * about["size"]
    # Rock and core, the rock, rock and lining; the last step's come first.
    assert [step["surface"] for step in about["steps"]] == [2, 1, 0, 0]
    quarter = np.pi / 4 * np.array([3**2 - 2.5**2, 0, 3**2]) + 60**2 - np.pi / 4 * 3**2
    for surface, exact in zip(about["surfaces"], quarter):
        a, b, c = (points[corner] for corner in arrays(surface["triangles"]).reshape(-1, 3).T)
        assert np.isclose(np.abs(np.cross(b - a, c - a)[:, 2]).sum() / 2, exact, rtol=1e-4)
    areas = [one.to_pyvista().compute_cell_sizes()["Area"].sum() for one in steps]
    assert np.allclose(areas, quarter[[2, 1, 0, 0]], rtol=1e-4)
    table = last.contacts["extrados"]
    a, b = (np.searchsorted(last.nodes, table[node]) for node in ("node_a", "node_b"))
    at = last.points + last.deformation
    apart = ((at[b] - at[a]) * table["normal"]).sum(axis=1)
    assert np.allclose(apart, table["gap"], atol=1e-9)
    assert table["gap"].max() > 5e-3
    assert [path.name for path in write_tables(last, tmp_path / "tables")] == ["extrados.csv"]


def contents(text):
    """The data of the view in a page, and a function that decodes its numbers."""
    about, packed = re.search(r'json">(.*?)</script><script type="text/plain">(.*?)</script>', text, re.DOTALL).groups()
    data = zlib.decompress(base64.b64decode(packed))
    return json.loads(about), lambda place: np.frombuffer(data, place["kind"], place["length"], place["at"])
