"""Output and errors of runs."""

import stat
import tomllib

import h5py
import meshio
import numpy as np
import pytest

from contact_dd import ContactError, IllPosed, InputError, Material, Model, NotConverged, OutputError, Result, toml
from contact_dd.tables import write_tables


def test_a_scene_is_read_as_it_was_written(scene):
    written = tomllib.loads(scene("mindlin").read_text())
    written["bodies"]["a \"name\" with é"] = {"material": "steel", "body_force": [0.0, -1e-7]}
    written["step"][0]["pressure"] = [{"on": ["top", "left"], "value": "x"}]
    written["solver"] = {"tolerance": np.float64(1e-9), "no_stress": True}
    assert tomllib.loads(toml.dumps(written)) == written


def test_messages_are_raised_by_exit_code(scene, tmp_path):
    path = scene("granite")

    def run(options=(), **changes):
        model = Model.from_scene(path)
        model.scene.update(changes)
        return model.run(options=options, progress=False)

    with pytest.raises(InputError, match="no physical group 'nothing'"):
        run(bilateral=[{"on": "nothing"}])
    with pytest.raises(InputError, match="--method"):
        run(["--method", "luck"])
    with pytest.raises(IllPosed, match="body 'block' is under-constrained"):
        run(displacement=[])
    with pytest.raises(OutputError, match=str(tmp_path / "no")):
        run(["--report", str(tmp_path / "no" / "report.json")])
    with pytest.warns(UserWarning, match="certificate"), pytest.raises(NotConverged) as raised:
        run(["--method", "picard", "--max-sweeps", "3"])
    assert raised.value.result.report["status"] == "not_converged"
    assert len(raised.value.result.points) == 2575


def test_a_result_is_printed_in_five_lines(scene):
    model = Model.from_scene(scene("granite"))
    result = model.run(progress=False)
    problem, size, status, stress, error = str(result).splitlines()
    assert problem == "Loaded granite block with cracks: plane strain, 2 contacts"
    assert size.startswith(f"{result.report['dofs']} degrees of freedom in ")
    closed = sum((table["status"] > 0).sum() for table in result.contacts.values())
    assert status.startswith("converged after ")
    assert f", {closed} of " in status
    assert stress == f"largest von Mises stress {result.von_mises.max():.5g} Pa"
    assert error == f"estimated error {result.report['error_estimate']['relative']:.2%} in the energy norm"
    assert repr(result).startswith("<Result of step 1 of 1 in ")
    without = str(model.run(options=["--no-stress"], progress=False))
    assert without.splitlines()[3:] == ["stresses were left out", "no error estimate"]


def test_a_warning_of_the_model_is_given_once(scene):
    model = Model.from_scene(scene("patch"))
    model.scene["contact"][0]["friction"] = 31.0
    with pytest.warns(UserWarning, match="a coefficient of 31") as given:
        result = model.run(ranks=1, progress=False)
    said = [str(one.message) for one in given]
    assert len(said) == len(set(said))
    assert any("a coefficient of 31" in one for one in result.report["warnings"])


def test_load_steps_are_named_where_a_result_is_printed(scene):
    last = Model.from_scene(scene("mindlin")).run(progress=False)
    first = last.at_step(1)
    for result, step in [(first, 1), (last, last.steps)]:
        lines = str(result).splitlines()
        assert lines[0].endswith(f", load step {step} of {last.steps}")
        assert len(lines) == 5
        assert f", {last.report['steps'][step - 1]['active_contacts']} of " in lines[2]


def test_contacts_are_found_between_bodies(scene):
    model = Model.from_scene(scene("stack3d"))
    explicit = model.run(progress=False)
    del model.scene["contact"]
    model.contact(between=["lower block", "middle block"], gap=0)
    model.contact(between="all", gap=0, name="joint")
    found = model.run(progress=False)
    assert set(found.contacts) == {"contact of lower block, middle block", "joint"}
    np.testing.assert_allclose(found.displacement, explicit.displacement, atol=1e-12 * abs(explicit.displacement).max())
    for wrong in [{}, {"a": "x"}, {"a": "x", "b": "y", "between": "all"}]:
        with pytest.raises(InputError, match="two sides, or the bodies between"):
            model.contact(**wrong)


def test_a_missing_program_is_named(scene, monkeypatch, tmp_path):
    model = Model.from_scene(scene("granite"))
    monkeypatch.setenv("MPIEXEC", "no-such-launcher")
    with pytest.raises(ContactError, match="there is no no-such-launcher to start 2 ranks"):
        model.run(progress=False)
    with pytest.raises(InputError, match="ranks=0"):
        model.run(ranks=0, progress=False)
    monkeypatch.setenv("CONTACT_DD_BIN", str(tmp_path))
    monkeypatch.setenv("PATH", str(tmp_path))
    with pytest.raises(ContactError, match="there is no contact-dd-partition: install"):
        model.run(progress=False)


def test_a_launcher_of_another_mpi_is_named(scene, monkeypatch, tmp_path):
    """One that sets what MPICH's does, and starts each rank by itself."""
    other = tmp_path / "mpirun"
    other.write_text('#!/bin/sh\nshift 2\nPMI_RANK=0 PMI_SIZE=2 "$@"\n')
    other.chmod(other.stat().st_mode | stat.S_IXUSR)
    monkeypatch.setenv("MPIEXEC", str(other))
    with pytest.raises(ContactError, match="launcher|MPI"):
        Model.from_scene(scene("granite")).run(progress=False)


def test_progress_is_printed_or_followed(scene, capsys):
    model = Model.from_scene(scene("granite"))
    events = []
    model.run(ranks=1, progress=events.append)
    assert [event["event"] for event in events][:2] == ["problem", "settings"]
    assert events[-1]["event"] == "finished"
    assert capsys.readouterr().out == ""
    model.run(ranks=1)
    printed = capsys.readouterr().out
    assert "5150 degrees of freedom, 1 rank\n" in printed
    assert "sweep 1: residual" in printed


def test_load_steps_are_results_of_their_own(scene, tmp_path):
    model = Model.from_scene(scene("granite"))
    model.steps({"scale": 0.5}, {"scale": {"pressure": 2.0}, "name": "twice"})
    result = model.run(folder=tmp_path / "run", progress=False)
    assert (result.step, result.steps) == (2, 2)
    first = result.at_step(1)
    assert np.allclose(result.displacement, 4 * first.displacement, rtol=1e-6, atol=1e-12)
    assert np.allclose(result.contacts["left crack"]["pressure"], 4 * first.contacts["left crack"]["pressure"])
    assert np.allclose(result.cell_data["VonMises"], 4 * first.cell_data["VonMises"])
    assert result.report["steps"][1]["name"] == "twice"
    assert Result(tmp_path / "run/scene.vtkhdf", 1).displacement.tobytes() == first.displacement.tobytes()
    with pytest.raises(InputError, match="there is no step 3; expected 1 to 2"):
        result.at_step(3)
    model.run(folder=tmp_path / "run", progress=False)
    with pytest.raises(InputError, match="scene.vtkhdf: another run has written it since it was read"):
        result.at_step(1)
    with pytest.raises(InputError, match="is a problem file"):
        Result(tmp_path / "run/scene.h5")
    with pytest.raises(InputError, match="isn't a result"):
        Result(tmp_path / "run/scene.toml")


def test_what_a_model_lacks_is_said():
    triangle = b"$MeshFormat\n"
    model = Model(triangle, {"plane": "strain"})
    model.body("block", Material(young=1.0, poisson=0.3))
    model.body("other", Material(young=1.0, poisson=0.3))
    assert list(model.scene["materials"]) == ["material 1"]
    with pytest.raises(InputError, match="there is no body 'brick'"):
        model.load("brick", body_force=[0, -1])
    with pytest.raises(InputError, match="expected a pressure, a traction, a force or a body force"):
        model.load("block")
    model.load("block", body_force=[0, -1])
    model.fix("block")
    assert model.scene["bodies"]["block"]["body_force"] == [0, -1]
    assert model.scene["displacement"] == [{"on": "block", "x": 0.0, "y": 0.0}]


def test_fields_are_those_of_the_file_in_pyvista(scene):
    import pyvista

    result = Model.from_scene(scene("stack")).run(progress=False)
    grid = result.to_pyvista()
    of_file = pyvista.merge(list(pyvista.read(result.path)), merge_points=False)
    assert grid.n_cells == of_file.n_cells
    assert np.isclose(grid.compute_cell_sizes()["Area"].sum(), of_file.compute_cell_sizes()["Area"].sum())
    order = [np.lexsort(mesh.cell_centers().points.round(9).T) for mesh in (grid, of_file)]
    assert np.array_equal(grid["VonMises"][order[0]], of_file["VonMises"][order[1]])
    assert np.abs(grid["Displacement"]).max() == np.abs(of_file["Displacement"]).max()


def test_a_node_between_two_materials_may_have_two_stresses():
    from contact_dd.result import unique_nodes

    tags = np.array([7, 5, 7, 7])
    stress = np.array([[1.0], [2.0], [1.0], [3.0]])
    kept, row = unique_nodes(tags, stress)
    assert tags[kept].tolist() == [5, 7, 7]
    assert stress[kept][row].tolist() == stress.tolist()
    assert tags[kept][row].tolist() == tags.tolist()
    kept, row = unique_nodes(tags, np.zeros((0, 6)))
    assert kept.tolist() == [1, 0]
    assert row.tolist() == [1, 0, 1, 1]


def test_a_hot_body_between_walls_is_pressed(tmp_path):
    points = np.array([[0, 0], [2, 0], [2, 1], [0, 1]], dtype=float)
    mesh = meshio.Mesh(
        points, [("quad", [[0, 1, 2, 3]])], cell_sets={"bar": [[0]]},
        point_sets={"left": [0, 3], "bottom": [0, 1], "right": [1, 2]},
    )
    model = Model.from_mesh(mesh, "stress")
    model.body("bar", Material(young=20e9, poisson=0.25), initial_stress=[1e6, 0, 0],
               thermal={"expansion": 1e-5, "temperature": 0})
    model.fix("left", x=0)
    model.fix("right", x=0)
    model.fix("bottom", y=0)
    model.steps({}, {"temperature": {"bar": 80}})
    result = model.run(ranks=1, folder=tmp_path, progress=False)
    assert np.allclose(result.at_step(1).stress[:, 0], 1e6)
    assert np.allclose(result.stress[:, 0], 1e6 - 20e9 * 1e-5 * 80)


def test_tables_follow_the_arc_length(scene, tmp_path):
    result = Model.from_scene(scene("hertz")).run(folder=tmp_path, progress=False)
    (path,) = write_tables(result, tmp_path / "tables")
    table = np.genfromtxt(path, delimiter=",", names=True)
    assert len(table) == sum(map(len, result.contacts.values()))
    assert (np.diff(table["arc_length"]) > 0).all()
    # The line is straight, and its half carries 5.
    assert np.allclose(table["arc_length"], table["x"] - table["x"][0])
    assert np.isclose(table["force"].sum(), 5, rtol=1e-3)
    with h5py.File(result.path) as file:
        at_nodes = file["VTKHDF/PointData/VonMises"][:]
    assert np.isclose(result.von_mises.max(), at_nodes.max())


def test_tables_of_contacts_in_space_have_no_arc_length(scene, tmp_path):
    result = Model.from_scene(scene("cube-crack")).run(folder=tmp_path, progress=False)
    for path in write_tables(result, tmp_path):
        table = np.genfromtxt(path, delimiter=",", names=True)
        assert np.allclose(table["z"], result.contacts[path.stem]["position"][:, 2])
        assert "arc_length" not in table.dtype.names


def test_a_page_in_space_has_pictures_of_the_bodies(scene, tmp_path):
    from contact_dd.drawing import space
    from contact_dd.drawing.page import page
    from contact_dd.drawing.surface import area

    result = Model.from_scene(scene("stack3d")).run(folder=tmp_path, progress=False)
    text = page(result)
    assert text.count('src="data:image/png;base64,') == 1
    assert text.count("src=") == 1
    assert not any(tag in text for tag in ("<link", "<script src", "@import"))
    solid = space.Solid(result)
    assert list(solid.pictures()) == ["displacement", "von_mises", "pressure"]
    # The surface is closed and looks outward, and sides a are the faces of contacts: 3 m by 3 m and 2 m by 2 m.
    polygons = [result.points[face] for face in solid.faces]
    assert np.isclose(sum(area(polygon) @ polygon.mean(axis=0) for polygon in polygons) / 3, 29)
    sides = {name: solid.side(table) for name, table in result.contacts.items()}
    sizes = [sum(np.linalg.norm(area(result.points[face])) for face in faces) for faces, _ in sides.values()]
    assert np.allclose(sizes, [9, 4])
    for name, (_, pressures) in sides.items():
        table = result.contacts[name]
        assert 0 < pressures.max() <= table["pressure"].max()
    # Of a crack, 3.354 m by 3 m, up to its tips.
    cracked = Model.from_scene(scene("cube-crack")).run(folder=tmp_path, progress=False)
    faces, _ = space.Solid(cracked).side(cracked.contacts["left crack"])
    assert np.isclose(sum(np.linalg.norm(area(cracked.points[face])) for face in faces), 3 * 45**0.5 / 2)
    bare = Model.from_scene(scene("stack3d")).run(folder=tmp_path, options=["--no-stress"], progress=False)
    assert list(space.Solid(bare).pictures()) == ["displacement", "pressure"]
    assert "base64" in page(bare)


def test_crosses_stand_on_an_even_grid(scene, tmp_path):
    from contact_dd.drawing.paper import grid_of
    from contact_dd.drawing.plane import Plane

    plane = Plane(Model.from_scene(scene("plain", "--element", "quad8")).run(folder=tmp_path, progress=False))
    points, cells, step = grid_of(plane)
    apart = (points - points[0]) / step
    assert np.allclose(apart, apart.round(), atol=1e-6)
    # None in the hole, and as many as there is room for.
    hole = plane.points[np.linalg.norm(plane.points, axis=1).argmin()]
    assert (np.linalg.norm(points, axis=1) > 0.99 * np.linalg.norm(hole)).all()
    area = np.ptp(plane.points, axis=0).prod() - np.pi / 4 * np.linalg.norm(hole) ** 2
    assert abs(len(points) * step**2 / area - 1) < 0.05
    middle = plane.centers()[cells]
    nodes = plane.cells[0].nodes
    across = np.ptp(plane.points[nodes], axis=1).max(axis=1)[np.argsort(plane.cells[0].members)][cells]
    assert (np.linalg.norm(points - middle, axis=1) < across).all()
