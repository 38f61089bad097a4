"""Studies: the quantities of many cases, as a user asks for them."""

import csv
import subprocess
import sys

import h5py
import numpy as np
import pytest
from test_quantities import pressed

from contact_dd import InputError, Model
from contact_dd.study import Study, numbers


def test_a_study_has_the_bits_of_single_runs():
    table = pressed().study({"friction": [0.1, 0.4], "joint': gap": [0.0, 1e-6]}, progress=False)
    assert table.parameters == ("contact 'joint': friction", "contact 'joint': gap")
    assert table.values.tolist() == [[0.1, 0.0], [0.1, 1e-6], [0.4, 0.0], [0.4, 1e-6]]
    assert table.status == ("converged",) * 4
    for gap, row in ((0.0, 2), (1e-6, 3)):
        result = pressed(gap=gap).run(progress=False)
        assert {name: of[row] for name, of in table.quantities.items()} == result.quantities
    alone = pressed().study({"friction": [0.1]}, ranks=1, progress=False)
    assert all(of[0] == table.quantities[name][0] for name, of in alone.quantities.items())


def test_loads_vary_by_their_factors():
    table = pressed().study({"pressure": [0.5, 1.0, 2.0]}, progress=False)
    assert table.quantities["grip"] == pytest.approx([1e6, 2e6, 4e6], rel=1e-12)
    for load, sag in ((0.5, table.quantities["sag"][0]), (2.0, table.quantities["sag"][2])):
        alone = pressed(load=load).run(progress=False)
        assert sag == pytest.approx(alone.quantities["sag"], rel=1e-11)


def test_what_a_study_cannot_vary_is_refused_with_what_it_can():
    model = pressed()
    for name, expected in (
        ("young", "a study of this scene varies loads, gaps and friction: .*contact 'joint': gap"),
        ("materials.material 1.young", "is a stiffness"),
        ("upper", "several parameters have 'upper' in its name"),
    ):
        with pytest.raises(InputError, match=expected):
            model.study({name: [1.0]}, progress=False)
    with pytest.raises(InputError, match="of friction 0 or more"):
        model.study({"friction": [-1.0]}, progress=False)
    with pytest.raises(InputError, match="varies nothing"):
        model.study({}, progress=False)


def test_the_command_writes_tables(tmp_path):
    scene = pressed().write(tmp_path)

    def study(*args):
        command = [sys.executable, "-m", "contact_dd", "study", str(scene), "--folder", str(tmp_path / "out"), *args]
        return subprocess.run(command, capture_output=True, text=True, check=False)

    done = study("--vary", "friction=0.1:0.4:0.1")
    assert done.returncode == 0, done.stderr
    path = tmp_path / "out" / f"{scene.stem}.study.csv"
    with path.open() as file:
        rows = list(csv.reader(file))
    assert rows[0] == ["contact 'joint': friction", "sag", "grip", "held", "status"]
    assert [row[0] for row in rows[1:]] == ["0.1", "0.2", "0.3", "0.4"]
    with h5py.File(path.with_suffix(".h5")) as file:
        assert file["quantities"].asstr()[:].tolist() == rows[0][1:4]
        np.testing.assert_array_equal(file["table"][:], [[float(x) for x in row[1:4]] for row in rows[1:]])
    assert "<svg" in path.with_suffix(".svg").read_text()
    for wrong in ("friction", "friction=0:1:0.3", "friction=a", "=1"):
        done = study("--vary", wrong)
        assert done.returncode == 2
        assert "expected name=first:last:step" in done.stderr


@pytest.mark.parametrize("values", [2.0, "2.0", None, ["a"], [[1.0]], [1.0, float("nan")], [float("inf")]])
def test_values_of_a_study_that_are_no_list_of_numbers_are_refused(values):
    with pytest.raises(InputError, match="parameter 'pressure': .*; expected a list of finite numbers"):
        numbers("pressure", values)


def test_the_plot_has_a_line_for_every_combination_of_what_else_varies():
    values = np.array([[0.3, 1.0], [0.1, 1.0], [0.2, 2.0], [0.1, 2.0], [0.2, 1.0]])
    sag = np.array([3.0, 1.0, 4.0, 2.0, np.nan])
    status = ("converged",) * 4 + ("ill_posed",)
    table = Study(("friction", "load"), values, {"sag": sag, "grip": 2 * sag}, {}, status)
    axes = table.plot().axes
    assert [one.get_ylabel() for one in axes] == ["sag", "grip"]
    first, second, missing = axes[0].lines
    np.testing.assert_array_equal(first.get_xydata(), [[0.1, 1.0], [0.2, np.nan], [0.3, 3.0]])
    np.testing.assert_array_equal(second.get_xydata(), [[0.1, 2.0], [0.2, 4.0]])
    assert [first.get_label(), second.get_label()] == ["load = 1", "load = 2"]
    assert missing.get_xdata() == [0.2, 0.2]


def test_a_quantity_of_a_crack_tip_is_that_of_the_report(scene):
    model = Model.from_scene(scene("granite"))
    model.quantity("slide", "k_ii", tip="left crack, tip 1")
    result = model.run(progress=False)
    [tip] = [one for one in result.report["crack_tips"] if one["tip"] == "left crack, tip 1"]
    assert result.quantities["slide"] == pytest.approx(tip["k_ii"], rel=1e-11)
    # Of a frictionless scene that is held everything grows with the loads together, as far as nothing opens or closes.
    loads = {name: of for name, of in result.gradient("slide").items() if name.startswith("pressure")}
    assert sum(loads.values()) == pytest.approx(tip["k_ii"], rel=1e-9)
