"""Error bars by comparison of meshes, against exact answers."""

from types import SimpleNamespace

import edges
import gmsh
import numpy as np
import pytest

from contact_dd import InputError, Material, Model, adapt, compare
from contact_dd.comparison import bar, numbers_of


def on_meshes(scene, name, *options, meshes):
    return [Model.from_scene(scene(name, "--refine", str(k), *options)).run(progress=False) for k in meshes]


def found(results, name):
    [one] = [one for one in compare(results) if one.name == name]
    return one


def holds(one, exact, at_most):
    """Whether the exact number is within the error bar, which isn't too long."""
    off = abs(one.values[-1] - exact)
    return off <= one.error <= at_most * off


def test_the_order_of_powers_is_found():
    sizes = np.array([1.0, 0.6, 0.25])
    for order in 0.5, 0.999, 1.7, 3.0:
        error, seen = bar(3 + 0.1 * sizes**order, sizes[:-1] / sizes[1:], 1e-12)
        assert np.isclose(seen, order)
        true = 0.1 * sizes[-1] ** order
        assert np.isclose(error, 1.25 * true) if order < 1 else error > 1.25 * true


def test_an_order_above_that_of_cells_widens_the_bar():
    # Of order 1, the last of them off by chance, so that a difference is small: its order is 20.
    true, values = 3.0, [3.4, 3.2, 3.1999]
    error, order = bar(values, [2, 2], 1e-12)
    assert order > 10
    assert error >= 0.1
    # Two that are alike tell no more than that.
    error, _ = bar([3.4, 3.2, 3.2], [2, 2], 1e-12)
    assert error >= abs(values[-1] - true)


def test_what_grows_or_sways_has_no_order():
    assert bar([1.0, 1.1, 1.3], [2, 2], 1e-12) == (None, 0)
    error, order = bar([1.0, 1.2, 1.1], [2, 2], 1e-12)
    assert order is None
    assert error >= 0.2


def made_up(monkeypatch, *meshes):
    """Results of meshes one twice as fine as the other, with these numbers by their kinds and names."""
    results = [SimpleNamespace(report={"dofs": 100 * 4**k}, is_in_space=False, path=f"{k}.vtkhdf") for k in (0, 1, 2)]
    of = {result.path: numbers for result, numbers in zip(results, meshes, strict=True)}

    def told(result):
        return (((kind, name, "m"), value) for (kind, name), value in of[result.path].items())

    monkeypatch.setattr("contact_dd.comparison.numbers_of", told)
    monkeypatch.setattr("contact_dd.comparison.without_limit", lambda meshes, ratio: set())
    return results


def test_a_negative_stress_intensity_factor_has_the_bar_of_a_positive_one(monkeypatch):
    key = ("stress intensity", "K_II of crack, tip 1")
    errors = []
    for sign in 1, -1:
        [one] = compare(made_up(monkeypatch, {key: sign * 8.0}, {key: sign * 9.0}, {key: sign * 9.5}))
        errors.append(one.error)
    assert errors[0] == errors[1] is not None


def test_what_only_one_result_has_is_named(monkeypatch):
    force, factor = ("force", "force on crack, x"), ("stress intensity", "K_I of crack, tip 2")
    fine = {force: 1.0, factor: 2.0}
    with pytest.raises(InputError, match=r"0\.vtkhdf has no 'K_I of crack, tip 2' in m; expected .* crack tips"):
        compare(made_up(monkeypatch, {force: 1.1}, fine, fine))
    with pytest.raises(InputError, match=r"2\.vtkhdf has no 'K_I of crack, tip 2'"):
        compare(made_up(monkeypatch, fine, fine, {force: 1.1}))


def test_hertz(scene):
    results = on_meshes(scene, "hertz", "--element", "quad8", meshes=(2, 0, 1))
    peak = found(results, "largest pressure of contact")
    assert list(peak.values) == sorted(peak.values, reverse=True)
    assert 1.7 < peak.order < 2.3
    assert holds(peak, 9.35135, at_most=8)
    assert holds(found(results[1:], "largest pressure of contact"), 9.35135, at_most=10)
    assert not any(one.error > 1e-8 for one in compare(results) if one.name.startswith("force on contact, y"))
    with pytest.raises(InputError, match="expected cells"):
        compare([results[0], results[0]])
    other = on_meshes(scene, "patch", meshes=(0,))
    with pytest.raises(InputError, match="several scenes: .* has no 'force on contact, x' in N/m, "):
        compare([results[0], *other])


def test_the_work_of_friction_in_mindlins_cylinders(scene):
    results = on_meshes(scene, "mindlin", "--element", "quad4", meshes=(0, 1))
    assert holds(found(results, "work of friction"), 0.09803, at_most=20)


def test_a_bounded_pressure_at_a_rim_has_no_bar(scene):
    # Each kind of cells has its own limit at the mouths of the cracks, by what quadrilaterals and quadratic cells say.
    results = on_meshes(scene, "granite", meshes=(0, 1, 2))
    for crack in "left", "right":
        assert found(results, f"largest pressure of {crack} crack").error is None
    assert found(results, "force on right crack, y").error is not None


def test_the_work_of_friction_is_known_no_better_than_energies():
    for cells in "tri", "quad":
        results = edges.on_meshes(edges.sharp_punch, (cells, 1), [0.5, 0.25, 0.125])
        # Next to nothing slips: on the best meshes 0.0211 mJ.
        work = found(results, "work of friction")
        assert abs(work.values[-1] - 0.0211) > 0.005
        assert work.error is None or work.error > 0.005
        results = edges.on_meshes(edges.beam, (cells, 1), [0.5, 0.25, 0.125])
        # Where much slips there is one: on the best meshes 0.0116 mJ.
        work = found(results, "work of friction")
        assert abs(work.values[-1] - 0.0116) < work.error < 0.2 * work.values[-1]


def test_rings_of_lame(tmp_path):
    # Quarters of two rings in plane strain, the inner one too large by `excess`.
    inner, joint, outer, excess = 1.0, 2.0, 3.0, 1e-3
    steel = Material(young=200e3, poisson=0.3)
    results = []
    for size in 0.4, 0.2, 0.1:
        gmsh.initialize()
        try:
            gmsh.option.setNumber("General.Terminal", 0)
            gmsh.option.setNumber("Mesh.MeshSizeMax", size)
            groups = {"flat": [], "upright": []}
            for name, low, high in (("core", inner, joint), ("ring", joint, outer)):
                corners = [gmsh.model.geo.addPoint(*at, 0) for at in ((low, 0), (high, 0), (0, high), (0, low))]
                middle = gmsh.model.geo.addPoint(0, 0, 0)
                flat = gmsh.model.geo.addLine(corners[0], corners[1])
                over = gmsh.model.geo.addCircleArc(corners[1], middle, corners[2])
                upright = gmsh.model.geo.addLine(corners[2], corners[3])
                under = gmsh.model.geo.addCircleArc(corners[3], middle, corners[0])
                loop = gmsh.model.geo.addCurveLoop([flat, over, upright, under])
                surface = gmsh.model.geo.addPlaneSurface([loop])
                gmsh.model.geo.synchronize()
                gmsh.model.addPhysicalGroup(2, [surface], name=name)
                gmsh.model.addPhysicalGroup(1, [over if name == "core" else under], name=f"joint of {name}")
                groups["flat"].append(flat)
                groups["upright"].append(upright)
            for name, curves in groups.items():
                gmsh.model.addPhysicalGroup(1, curves, name=name)
            gmsh.model.mesh.generate(2)
            model = Model.from_mesh(gmsh.model, plane="strain")
        finally:
            gmsh.finalize()
        for name in "core", "ring":
            model.body(name, steel)
        model.fix("flat", y=0)
        model.fix("upright", x=0)
        model.contact("joint of core", "joint of ring", name="joint", gap=-excess)
        results.append(model.run(progress=False, folder=tmp_path / str(size)))
    # Lame's displacements of the two faces, with the modulus of plane strain; Poisson's ratio cancels.
    modulus = steel.young / (1 - steel.poisson**2)
    yields = sum((high**2 + low**2) / (high**2 - low**2) for low, high in ((inner, joint), (joint, outer)))
    pressure = excess * modulus / (joint * yields)
    assert holds(found(results, "force on joint, y"), -pressure * joint, at_most=20)
    # At the ends of the joint it hasn't begun to converge; that isn't called a small error.
    peak = found(results, "largest pressure of joint")
    assert peak.error is None or abs(peak.values[-1] - pressure) <= peak.error


def test_bars_of_linear_cells_with_edges_and_friction_hold_the_truth(tmp_path):
    """By meshes of second order that have adapted. What has no limit has no bar."""
    barred, off = 0, {}
    for scene in (edges.rounded_punch, edges.dovetail):
        size = edges.SCENES[scene]
        best, _ = adapt(scene(size, ("tri", 2)), 2e-3, ranks=1, progress=False)
        gmsh.finalize()
        truth = {name: value for (_, name, _), value in numbers_of(best)}
        for cells in ("tri", "quad"):
            results = edges.on_meshes(scene, (cells, 1), [size / 2, size / 4, size / 8])
            found = compare(results)
            outside, count = edges.outside(found, truth)
            barred += count
            off |= {(scene.__name__, cells, name): bars for name, bars in outside.items()}
            if scene is not edges.rounded_punch:
                # A sharp edge lies on a face.
                [pressure] = [one for one in found if one.name.startswith("largest pressure")]
                assert pressure.error is None
    assert barred > 15
    assert len(off) <= 0.05 * barred, off
    assert max(off.values(), default=0) < 3, off
    assert not any(name == "work of friction" for _, _, name in off), off
