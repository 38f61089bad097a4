"""Quantities and their derivatives, as a user asks for them."""

import pytest
from test_ties import two_squares

from contact_dd import InputError, Material, Model


def pressed(load=1.0, gap=0.0, push=0.1):
    """Two squares pressed on each other, the upper one pushed to the side against friction."""
    model = Model.from_mesh(two_squares(), plane="strain")
    for body, young in (("lower", 200e9), ("upper", 70e9)):
        model.body(body, Material(young=young, poisson=0.3))
    model.fix("lower bottom")
    model.load("upper top", pressure=load * 2e6)
    model.load("upper left", traction=[push * 2e6, 0.0])
    model.contact("upper bottom", "lower top", name="joint", friction=0.4, gap=gap)
    model.quantity("sag", "displacement", node=41, direction="y")
    model.quantity("grip", "contact_force", contact="joint")
    model.quantity("held", "reaction", on="lower bottom", direction="x")
    return model


def test_quantities_have_values_and_gradients_by_their_names():
    result = pressed().run(progress=False)
    assert set(result.quantities) == {"sag", "grip", "held"}
    node = list(result.nodes).index(41)
    assert result.quantities["sag"] == pytest.approx(result.displacement[node, 1], rel=1e-13)
    # Statics: what presses is the load, and what is held is the push.
    assert result.gradient("grip")["pressure[1] on 'upper top'"] == pytest.approx(2e6, rel=1e-9)
    assert result.gradient("held")["traction[1] on 'upper left'"] == pytest.approx(-0.2e6, rel=1e-9)
    assert "materials.material 1.young" in result.gradient("sag")
    step = 1e-4
    ahead, back = (pressed(load=1 + by).run(progress=False).quantities["sag"] for by in (step, -step))
    slope = result.gradient("sag")["pressure[1] on 'upper top'"]
    assert slope == pytest.approx((ahead - back) / (2 * step), rel=1e-6)


def test_a_quantity_that_is_none_is_refused_by_its_call_and_by_what_there_is():
    model = pressed()
    model.quantity("more", "contact_force", contact="jiont")
    with pytest.raises(InputError, match=r"there is no contact 'jiont'; did you mean 'joint'\?"):
        model.run(progress=False)
    with pytest.raises(InputError, match=r"no quantity 'grop'; known are 'sag', 'grip', 'held'"):
        pressed().run(progress=False).gradient("grop")
