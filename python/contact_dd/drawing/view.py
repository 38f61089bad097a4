"""A result that turns and zooms in a page: its surface by a field, deformed, drawn by the browser (view.js).

In the page stand JSON, which says what there is, and the numbers, compressed."""

import base64
import json
import zlib
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

from contact_dd.drawing import shapes
from contact_dd.drawing.carried import carried, pressing
from contact_dd.drawing.finite import check_finite
from contact_dd.drawing.html import escape
from contact_dd.drawing.space import VIEW, Solid
from contact_dd.drawing.units import in_units, units_of

# Above it only the last load step is in the page (bytes, before compression).
MOST_BYTES = 20_000_000
# The share of nodes up to whose values colours go; those above have the last one.
SHARE = 0.99
COLOURS = {"displacement": "cividis", "von Mises stress": "viridis", "contact pressure": "inferno_r"}


class Numbers:
    """Arrays one after the other, by their places."""

    def __init__(self):
        self.bytes = bytearray()

    def place(self, values, kind):
        at = len(self.bytes)
        self.bytes += np.ascontiguousarray(values, dtype=kind).tobytes()
        # Arrays of a browser begin at multiples of their numbers' size.
        self.bytes += bytes(-len(self.bytes) % 4)
        return {"at": at, "length": int(np.size(values)), "kind": kind}

    def packed(self):
        return base64.b64encode(zlib.compress(bytes(self.bytes), 9)).decode()


def view(result, scale, picture):
    """The view, in HTML, displacements enlarged by `scale`; `picture` is there where the page is printed or the browser
    can't draw."""
    about, numbers = contents(result, scale)
    script = Path(__file__).with_name("view.js").read_text(encoding="utf-8")
    turns = "drag to turn, with shift to move" if about["turns"] else "drag to move"
    fields = "".join(f"<option>{escape(field['name'])}</option>" for field in about["steps"][-1]["fields"])
    steps = "".join(f"<option>{escape(step['name'])}</option>" for step in about["steps"])
    # No name ends the script.
    data = json.dumps(about).replace("<", "\\u003c")
    return (
        f'<div id="view"><div class="still">{picture}</div><div class="live" hidden>'
        f'<p class="controls"><label>colour <select name="field">{fields}</select></label>'
        f'<label{" hidden" if len(about["steps"]) == 1 else ""}>step <select name="step">{steps}</select></label>'
        '<label>deformation <input name="scale" type="range" min="0" max="3" step="0.05" value="1"> '
        '<output name="scale"></output></label>'
        '<label><input name="edges" type="checkbox" checked> cells</label></p>'
        f'<canvas tabindex="0" aria-label="The surface of the bodies; {turns}, arrow keys and + - too"></canvas>'
        '<p class="bar"><span name="low"></span><i></i><span name="high"></span></p>'
        f'<p><small>{turns}, turn the wheel to zoom, click twice for the whole '
        '<output name="here"></output></small></p>'
        f'</div><script type="application/json">{data}</script>'
        f'<script type="text/plain">{numbers}</script></div><script>{script}</script>'
    )


def contents(result, scale):
    """Contents of the view, and its numbers, packed."""
    numbers = Numbers()
    steps = steps_of(result)
    for one in steps:
        check_finite(one)
    found, of_steps = surfaces_of(steps)
    kept = np.unique(np.concatenate([face for faces, _ in found for face in faces]))
    row = np.zeros(len(result.nodes), dtype=np.uint32)
    row[kept] = np.arange(len(kept))
    points = result.points[kept]
    low, high = points.min(axis=0), points.max(axis=0)
    size = float(np.linalg.norm(high - low))
    about = {
        "turns": result.is_in_space, "azimuth": VIEW["azim"], "elevation": VIEW["elev"],
        "center": ((low + high) / 2).tolist(), "size": size, "scale": scale,
        "length": units_of(result).length, "nodes": numbers.place(result.nodes[kept], "<u4"),
        "points": numbers.place((points - (low + high) / 2) / size, "<f4"),
        "surfaces": [surface(row, faces, sides, numbers) for faces, sides in found],
        "maps": {name: numbers.place(map_of(name), "<u1") for name in set(COLOURS.values())},
    }
    has_sides = any(sides for _, sides in found)
    about["steps"] = [
        {**step(one, kept, size, has_sides, numbers), "surface": number} for one, number in zip(steps, of_steps)
    ]
    return about, numbers.packed()


def surfaces_of(steps):
    """The faces of the bodies, and of sides of contacts that press, for every choice of bodies that are there in some
    step, and which one each step has."""
    found, known, of_steps = [], {}, []
    for one in reversed(steps):
        key = one.cell_data.get("Present", np.zeros(0)).tobytes()
        if key not in known:
            known[key] = len(found)
            solid = Solid(one) if one.is_in_space else None
            sides = [face for table in solid.pressed.values() for face in solid.side(table)[0]] if solid else []
            found.append((solid.faces if solid else plane_faces(one.cells), sides))
        of_steps.insert(0, known[key])
    return found, of_steps


def surface(row, faces, sides, numbers):
    """Where the triangles and edges of faces are, and the triangles of sides."""
    placed = {
        "triangles": numbers.place(row[np.concatenate([triangles(face) for face in faces])], "<u4"),
        "edges": numbers.place(row[np.concatenate([np.stack([f, np.roll(f, -1)], 1) for f in faces])], "<u4"),
    }
    if sides:
        placed["sides"] = numbers.place(row[np.concatenate([triangles(face) for face in sides])], "<u4")
    return placed


def steps_of(result):
    """The load steps, the last one alone where they are too much or a node isn't in all the same."""
    if result.steps == 1:
        return [result]
    faces = Solid(result).faces if result.is_in_space else plane_faces(result.cells)
    if result.steps * len(np.unique(np.concatenate(faces))) * 20 > MOST_BYTES:
        return [result]
    found = [result.at_step(k) for k in range(1, result.steps)]
    return [one for one in found if np.array_equal(one.nodes, result.nodes)] + [result]


def step(result, kept, size, has_sides, numbers):
    """A load step: displacements over the size, and the fields."""
    units = units_of(result)
    values = {"von Mises stress": (result.von_mises[kept], units.stress)} if len(result.stress) else {}
    values["displacement"] = (np.linalg.norm(result.displacement, axis=1)[kept], units.length)
    if has_sides:
        tags, points = np.unique(result.nodes, return_inverse=True)
        pressure = np.zeros(len(tags))
        for table in carried(pressing(result)).values():
            np.maximum.at(pressure, np.searchsorted(tags, table["node_a"]), table["pressure"])
        values["contact pressure"] = (pressure[points[kept]], units.stress)
    steps = result.report.get("steps")
    return {
        "name": steps[result.step - 1]["name"] if steps else "",
        "displacements": numbers.place(result.deformation[kept] / size, "<f4"),
        "fields": [field(name, *of, numbers) for name, of in values.items()],
    }


def field(name, values, unit, numbers):
    """Values as 65535ths of the largest that has a colour of its own."""
    values, unit = in_units(values, unit)
    most = float(np.quantile(values, SHARE) if name == "von Mises stress" else values.max()) or 1.0
    shares = numbers.place(np.round(65535 * np.clip(values / most, 0, 1)), "<u2")
    largest = float(values.max())
    return {"name": name, "unit": unit, "most": most, "largest": largest, "map": COLOURS[name], "values": shares}


def map_of(name):
    """The colours of a map, red, green, blue and opacity."""
    return plt.get_cmap(name)(np.arange(256), bytes=True)


def plane_faces(cells):
    """The nodes around every plane cell."""
    faces = []
    for kind, _, nodes in cells:
        faces.extend(nodes[:, [node for facet in shapes.CELLS[kind].facets for node in facet[:-1]]])
    return faces


def triangles(face):
    """A face by triangles; nodes on its edges cut its corners off."""
    if len(face) < 6:
        return np.stack([np.full(len(face) - 2, face[0]), face[1:-1], face[2:]], axis=1)
    corners = np.stack([np.roll(face, 1)[::2], face[::2], face[1::2]], axis=1)
    return np.concatenate([corners, triangles(face[1::2])])
