"""Files that are overwritten, and files that are kept."""

import resource
import subprocess
import sys

import numpy as np
import pytest

from contact_dd import InputError, Material, Model, OutputError
from contact_dd.tables import write_tables


def test_a_scene_of_somebody_else_stays(scene):
    path = scene("hertz")
    before = {one: one.read_bytes() for one in (path, path.with_name("mesh.msh"))}
    for folder in (path.parent, str(path.parent)):
        with pytest.raises(InputError, match=r"scene\.toml: is there already, and wasn't written by contact_dd"):
            Model.from_scene(path).run(folder=folder, progress=False)
    assert {one: one.read_bytes() for one in before} == before
    assert sorted(one.name for one in path.parent.iterdir()) == ["mesh.msh", "scene.toml"]


def test_a_scene_that_was_changed_stays(scene, tmp_path):
    model = Model.from_scene(scene("hertz"))
    path = model.write(tmp_path)
    first = path.read_text()
    model.scene["title"] = "another"
    assert model.write(tmp_path).read_text() != first
    path.write_text(path.read_text() + "# a word of mine\n")
    with pytest.raises(InputError, match="was changed since; expected another folder"):
        model.write(tmp_path)
    assert path.read_text().endswith("# a word of mine\n")
    # Who removes it has what is written.
    path.unlink()
    assert "another" in model.write(tmp_path).read_text()


def test_a_mesh_of_somebody_else_stays(scene, tmp_path):
    mesh = tmp_path / "mesh.msh"
    mesh.write_bytes(scene("hertz").with_name("mesh.msh").read_bytes())
    model = Model.from_scene(scene("hertz", "--refine", "1"))
    finer = model.mesh
    with pytest.raises(InputError, match=r"mesh\.msh: is another mesh, not written by contact_dd"):
        model.write(tmp_path)
    model.mesh = mesh.read_bytes()
    # The same may be used; it doesn't become the package's by that.
    model.write(tmp_path)
    model.write(tmp_path)
    model.mesh = finer
    with pytest.raises(InputError, match=r"mesh\.msh: is another mesh"):
        model.write(tmp_path)
    # A mesh of its own is replaced, as when meshes adapt.
    model.write(tmp_path / "own")
    model.mesh = mesh.read_bytes()
    model.write(tmp_path / "own")
    assert (tmp_path / "own/mesh.msh").read_bytes() == mesh.read_bytes()


@pytest.mark.parametrize("command", ["report", "plot", "table"])
def test_what_is_there_stays_until_the_new_one_is_whole(scene, tmp_path, command):
    """As on a disk that becomes full: files may have 200 bytes, or any number of them."""
    result = Model.from_scene(scene("hertz")).run(folder=tmp_path / "run", progress=False)
    name = {"report": "scene.html", "plot": "figures/overview.png", "table": "tables/contact.csv"}[command]
    path = result.path.parent / name
    path.parent.mkdir(exist_ok=True)
    path.write_text("the old one")
    words = [sys.executable, "-m", "contact_dd", command, result.path]

    def small():
        resource.setrlimit(resource.RLIMIT_FSIZE, (200, 200))

    ended = subprocess.run(words, preexec_fn=small, capture_output=True, text=True)
    assert (ended.returncode, ended.stderr) == (5, f"error: {path}: can't be written: File too large\n")
    assert path.read_text() == "the old one"
    assert [one.name for one in path.parent.iterdir() if one.name.endswith(".part")] == []
    assert subprocess.run(words, capture_output=True).returncode == 0
    assert path.read_bytes() != b"the old one"


def test_a_page_behind_a_link_is_written_where_the_link_leads(scene, tmp_path):
    result = Model.from_scene(scene("hertz")).run(folder=tmp_path, progress=False)
    elsewhere = tmp_path / "elsewhere.html"
    elsewhere.write_text("old")
    (tmp_path / "page.html").symlink_to(elsewhere)
    command = [sys.executable, "-m", "contact_dd", "report", result.path, tmp_path / "page.html"]
    subprocess.run(command, check=True, capture_output=True)
    assert (tmp_path / "page.html").is_symlink()
    assert elsewhere.read_text().startswith("<!DOCTYPE html>")


def test_folders_that_cant_be_written_are_named(scene, tmp_path):
    file = tmp_path / "file"
    file.write_text("")
    model = Model.from_scene(scene("hertz"))
    for folder in (file, file / "below"):
        with pytest.raises(OutputError, match=f"{folder}.*: can't be written"):
            model.run(folder=folder, progress=False)
    result = model.run(folder=tmp_path / "run", progress=False)
    with pytest.raises(OutputError, match="can't be written"):
        write_tables(result, file)


def test_no_folder_for_what_is_made_on_the_way_is_said(scene, monkeypatch):
    monkeypatch.setattr("tempfile.tempdir", "/nowhere")
    with pytest.raises(OutputError, match="no temporary folder can be made"):
        Model.from_scene(scene("hertz")).run(progress=False)


def model_of(scene):
    model = Model.from_mesh(scene("granite").with_name("mesh.msh"), "strain")
    model.body("block", Material(young=5.2e9, poisson=0.18))
    model.fix("bottom")
    model.load("top", pressure=1e6)
    for side in ("left", "right"):
        model.contact(f"{side} crack lower", f"{side} crack upper", name=f"{side} crack", gap=0.0)
    return model


CALLS = {
    "fix('nothing'): the mesh has no physical group": lambda model: model.fix("nothing"),
    "fix('top', z=0).z: a plane scene": lambda model: model.fix("top", z=0),
    "load('top', pressure='1e6*(').value: expression": lambda model: model.load("top", pressure="1e6*("),
    "load('top', traction=[1, 2, 3]).value: a plane": lambda model: model.load("top", traction=[1, 2, 3]),
    "material of body('block').poisson: Poisson's": lambda model: model.body("block", Material(young=1, poisson=0.7)),
    "body('block', body_force=['q', 0]).body_force": lambda model: model.body(
        "block", Material(young=1.0, poisson=0.3), body_force=["q", 0]),
    "obstacle('top', point=[0, 0], normal=[0, 0]).obstacle.normal": lambda model: model.obstacle(
        "top", point=[0, 0], normal=[0, 0]),
    "contact('top', 'bottom', name='a', friction=-1).friction": lambda model: model.contact(
        "top", "bottom", name="a", friction=-1),
    "fix('bottom', x=1) prescribes 1 for the displacement along (1, 0, 0), fix('bottom') prescribes 0":
        lambda model: model.fix("bottom", x=1),
    "step 2 of steps.scal: unknown key 'scal'": lambda model: model.steps({}, {"scal": 1}),
    "step 1 of steps.pressure[1] on 'nix': the mesh": lambda model: model.steps(
        {"pressure": [{"on": "nix", "value": 1}]}),
    "pressure[2]": lambda model: model.scene["pressure"].append({"on": "nix", "value": 1}),
}


@pytest.mark.parametrize("words", CALLS)
def test_messages_name_the_call(scene, words):
    model = model_of(scene)
    CALLS[words](model)
    with pytest.raises(InputError) as raised:
        model.run(progress=False)
    said = str(raised.value)
    assert words in said
    assert "line " not in said
    assert "scene.toml" not in said


def test_messages_on_a_scene_name_its_file(scene):
    path = scene("granite")
    model = Model.from_scene(path)
    model.scene["pressure"][0]["on"] = "nix"
    with pytest.raises(InputError) as raised:
        model.run(progress=False)
    assert str(raised.value).startswith(f"{path}: pressure[1] on 'nix': the mesh has no")


WRONG = {
    r"ranks='a'; expected a whole number, 1 or more": {"ranks": "a"},
    r"ranks=1\.5; expected a whole number": {"ranks": 1.5},
    r"options='--check'; expected a list": {"options": "--check"},
    r"invalid value 'a' for '--subdomains": {"subdomains": "a"},
}


@pytest.mark.parametrize("words", WRONG)
def test_arguments_of_another_kind_are_said(scene, words):
    with pytest.raises(InputError, match=words):
        model_of(scene).run(progress=False, **WRONG[words])
    model_of(scene).run(ranks=np.int64(1), options=["--tolerance", 1e-9], progress=False)


def test_a_model_without_a_body_says_so(scene):
    model = Model.from_mesh(scene("granite").with_name("mesh.msh"), "strain")
    model.fix("bottom")
    with pytest.raises(InputError, match="the model has no body; expected a call of `body`"):
        model.run(progress=False)
    model.scene["x"] = object()
    model.body("block", Material(young=1.0, poisson=0.3))
    with pytest.raises(InputError, match="can't stand in a scene"):
        model.run(progress=False)
