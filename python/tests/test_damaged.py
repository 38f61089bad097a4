"""Results that are damaged or made to deceive, and names that mean something to what they are written with."""

import json
import shutil
import subprocess
import sys
import xml.etree.ElementTree

import h5py
import numpy as np
import pytest

from contact_dd import InputError, Material, Model, Result
from contact_dd.drawing.html import Html, table
from contact_dd.drawing.page import page
from contact_dd.drawing.pictures import draw
from contact_dd.report import REPORT, report_of

SCRIPT = "<script>alert(1)</script>"


@pytest.fixture(scope="module")
def granite(scene, tmp_path_factory):
    """With friction, in two load steps: every part of a page."""
    model = Model.from_scene(scene("granite-friction"))
    model.steps({"scale": 0.5}, {"scale": 1.0})
    return model.run(folder=tmp_path_factory.mktemp("run"), progress=False).path


@pytest.fixture
def changed(granite, tmp_path):
    """A copy of the result; a function changes its open file."""

    def change(by):
        path = tmp_path / "changed.vtkhdf"
        shutil.copy(granite, path)
        with h5py.File(path, "r+") as file:
            by(file)
        return path

    return change


def in_report(change):
    def by(file):
        report = json.loads(file.attrs["report"])
        change(report)
        file.attrs["report"] = json.dumps(report)

    return by


def leaves(value, path=()):
    """Where the report has something that isn't made of other things."""
    if isinstance(value, dict | list):
        for key, entry in value.items() if isinstance(value, dict) else enumerate(value):
            yield from leaves(entry, (*path, key))
    else:
        yield path


def set_at(report, path, value):
    for key in path[:-1]:
        report = report[key]
    report[path[-1]] = value


def ends_in_words(path, *command):
    ended = subprocess.run(
        [sys.executable, "-m", "contact_dd", *command, path], capture_output=True, text=True
    )
    assert ended.returncode == 2, (ended.returncode, ended.stderr[-500:])
    assert ended.stderr.startswith(f"error: {path}: "), ended.stderr
    assert len(ended.stderr.splitlines()) == 1
    return ended.stderr


def test_no_value_of_a_report_becomes_markup(granite, changed):
    text = h5py.File(granite).attrs["report"]
    taken, refused = [], []
    for path in leaves(json.loads(text)):
        report = json.loads(text)
        set_at(report, path, SCRIPT)
        try:
            report_of(json.dumps(report))
            taken.append(path)
        except ValueError as error:
            refused.append(str(error))
    # Numbers are refused, texts are taken.
    assert len(refused) > 100
    assert all("its report has" in words for words in refused)
    assert ("warnings", 0) in taken or ("settings", "output") in taken
    assert ("sweeps",) not in taken

    def in_all(report):
        for path in taken:
            set_at(report, path, SCRIPT)

    found = page(Result(changed(in_report(in_all))))
    assert SCRIPT not in found
    assert found.count("&lt;script&gt;") > 20


def test_every_value_of_a_table_is_escaped():
    assert table(["<b>"], [[SCRIPT, Html("<b>")]]).count("&lt;") == 3


def test_a_report_that_isnt_one_is_said(granite, changed):
    def text(content):
        def by(file):
            file.attrs["report"] = content

        return by

    assert "its report isn't JSON" in ends_in_words(changed(text("no JSON")), "report")
    assert "expected an object" in ends_in_words(changed(text("[1]")), "plot")
    for name in REPORT:
        with pytest.raises(InputError, match=f"nothing at /{name}"):
            Result(changed(in_report(lambda report, name=name: report.pop(name))))
    with pytest.raises(InputError, match="expected a number"):
        Result(changed(in_report(lambda report: report.update(dofs=float("nan")))))


def test_numbers_that_arent_finite_are_named_by_their_node(changed):
    for name in ("Displacement", "Stress"):

        def by(file, name=name):
            file["VTKHDF/PointData"][name][-100:] = np.nan

        path = changed(by)
        # The file itself can be read, to see what went wrong.
        assert np.isnan(getattr(Result(path), name.lower())).any()
        for command in ("plot", "report"):
            assert f"the {name.lower()} at node" in ends_in_words(path, command)
    path = changed(lambda file: file["contact/left crack/pressure"].write_direct(
        np.full(file["contact/left crack/pressure"].shape, np.inf)))
    with pytest.raises(InputError, match="pressure of contact 'left crack' at node"):
        page(Result(path))


def test_a_damaged_field_is_said(changed):
    def without(name):
        def by(file):
            del file[name]

        return by

    def instead(name, values):
        def by(file):
            del file[name]
            file[name] = values

        return by

    damages = [without("VTKHDF/Points"), without("convergence"), instead("VTKHDF/Types", np.full(3, 99)),
               instead("VTKHDF/PointData/GlobalNodeId", np.zeros(2)), instead("VTKHDF/Connectivity", np.full(9, -1)),
               instead("contact/left crack/status", np.float64(1)), lambda file: file.attrs.update(units="inch")]
    for damage in damages:
        ends_in_words(changed(damage), "report")


NAMES = ["$x^$", "100 $ and \\frac{", "<b>bold<br>", "a_b^c", "\u7a7a", "a\\n%s{}"]


@pytest.mark.filterwarnings("ignore:Glyph")
@pytest.mark.parametrize("names", [NAMES[k : k + 2] for k in (0, 2, 4)])
def test_names_are_drawn_as_they_are(scene, tmp_path, names):
    model = Model.from_scene(scene("granite"))
    for contact, name in zip(model.scene["contact"], names):
        contact["name"] = name
    model.scene["title"] = names[0]
    result = model.run(folder=tmp_path, progress=False)
    assert set(result.contacts) == set(names)
    text = page(result)
    drawn = [svg[: svg.index("</svg>") + 6] for svg in text.split("<svg")[1:]]
    words = [one for svg in drawn for one in xml.etree.ElementTree.fromstring(f"<svg{svg}").itertext()]
    assert set(names) <= {word.strip() for word in words}
    [(_, figure)] = draw(result, ["overview"])
    figure.canvas.draw()


def test_a_contact_in_space_is_named_as_it_is(scene, tmp_path):
    model = Model.from_scene(scene("stack3d"))
    for number, contact in enumerate(model.scene["contact"]):
        contact["name"] = f"$x^$ {number}"
    [(_, figure)] = draw(model.run(folder=tmp_path, progress=False), ["overview"])
    figure.canvas.draw()
    assert any("$x^$" in axes.get_title() for axes in figure.axes)


def test_texts_that_toml_has_no_letter_for_are_said(scene):
    model = Model.from_scene(scene("granite"))
    model.scene["title"] = "with \x7f"
    with pytest.raises(InputError, match="title: .* holds a control character"):
        model.run(progress=False)
    model.scene["title"] = "half \ud800"
    with pytest.raises(InputError, match="can't stand in a scene"):
        model.run(progress=False)
    del model.scene["title"]
    model.body("a\x7fb", Material(young=1.0, poisson=0.3))
    with pytest.raises(InputError, match="bodies.* holds a control character"):
        model.run(progress=False)
