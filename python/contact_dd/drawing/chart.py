"""A contact's side in space on paper: seen along its normal, unrolled where it goes around an axis, or the half of it
that is loaded."""

from dataclasses import dataclass

import numpy as np

# Cosine of the angle to the mean normal down to which a side is seen along that.
STEEP = 0.3
# Of unit normals the part along an axis, root mean square, up to which they stand around it.
AROUND_AXIS = 0.1
# Cosine of the angle to a coordinate's axis up to which a direction has its name.
NEARLY = 0.9995
# Angle that is round-off.
ON_THE_CUT = 1e-6


@dataclass
class Label:
    """Title of an axis."""

    name: str
    remark: str = ""
    """Second line, below the name."""

    def with_unit(self, unit):
        return f"{self.name} [{unit}]" + f"\n{self.remark}" * bool(self.remark)


@dataclass
class Chart:
    """Places of the conditions on paper."""

    rows: np.ndarray
    """Flags of the conditions that are seen."""
    x: np.ndarray
    y: np.ndarray
    labels: tuple[Label, Label]
    """Titles of the axes."""
    radius: float | None = None
    """Factor from an angle to x, where a side is unrolled."""


def chart_of(table):
    """The chart of a contact's table."""
    normals, points = table["normal"], table["position"]
    every = np.arange(len(table))
    mean = normals.mean(axis=0)
    length = np.linalg.norm(mean)
    if length > 0 and (normals @ mean).min() > STEEP * length:
        return seen_along(mean / length, every, points)
    loaded = table["pressure"] @ normals
    if np.linalg.norm(loaded) < 1e-3 * table["pressure"].sum():
        loaded = normals[table["pressure"].argmax()]
    _, sizes, directions = np.linalg.svd(normals, full_matrices=False)
    if sizes[-1] < AROUND_AXIS * np.sqrt(len(normals)):
        return unrolled(directions[-1], loaded, normals, points)
    loaded = loaded / np.linalg.norm(loaded)
    return seen_along(loaded, every[normals @ loaded > STEEP], points)


def seen_along(normal, rows, points):
    """In a plane across a normal."""
    first = np.cross(np.eye(3)[np.abs(normal).argmin()], normal)
    first /= np.linalg.norm(first)
    # Coordinates grow to the right and upwards, whichever side of it one would see.
    first, second = (axis * np.sign(axis[np.abs(axis).argmax()]) for axis in (first, np.cross(normal, first)))
    if np.abs(first).argmax() > np.abs(second).argmax():
        first, second = second, first
    x, y = placed(points[rows], first), placed(points[rows], second)
    return Chart(rows, x, y, (label_along(first), label_along(second)))


def unrolled(axis, loaded, normals, points):
    """A side around an axis by the arc length, and the place along the axis. The arc begins at the axis of coordinates
    that is nearest to where the side is loaded, if one is across, else there; the cut is opposite of the load."""
    axis = axis * np.sign(axis[np.abs(axis).argmax()])
    first = loaded - (loaded @ axis) * axis
    first /= np.linalg.norm(first)
    second = np.cross(axis, first)
    plane = np.stack([points @ first, points @ second], axis=1)
    # The circle |p|² = 2 c·p + r² − |c|² that fits best.
    system = np.column_stack([2 * plane, np.ones(len(plane))])
    (cx, cy, rest), *_ = np.linalg.lstsq(system, (plane**2).sum(axis=1), rcond=None)
    radius = np.sqrt(rest + cx**2 + cy**2)
    arm = plane - (cx, cy)
    # In a hole normals lead to the axis.
    inward = (arm * np.stack([normals @ first, normals @ second], axis=1)).sum() < 0
    angle = np.arctan2(*(-arm.T if inward else arm.T)[::-1])
    # Points on the cut belong to one side of it.
    angle[angle < ON_THE_CUT - np.pi] += 2 * np.pi
    zero, label = first_angle(axis, first, second, inward)
    rows = np.arange(len(points))
    return Chart(rows, radius * (angle - zero), placed(points, axis), (label, label_along(axis)), radius)


def first_angle(axis, first, second, inward):
    """Start of the angles around an axis, from its direction `first`, and their title, which names positions: in a
    hole these are opposite to the normals."""
    if np.abs(axis).max() <= NEARLY:
        return 0.0, Label("angle from the load")
    across = np.abs(axis) < 0.5
    along_each = np.where(across, first, 0.0)
    k = np.abs(along_each).argmax()
    direction = np.sign(along_each[k]) * np.eye(3)[k]
    sign = "−" if (along_each[k] < 0) != inward else ""
    label = Label(f"angle from {sign}{'xyz'[k]} about {coordinate_of(axis)}")
    return np.arctan2(direction @ second, direction @ first), label


def placed(points, direction):
    """Coordinates along a direction: the scene's along one of its axes, else the distance from the first point."""
    at = points @ direction
    return at if np.abs(direction).max() > NEARLY else at - at.min()


def coordinate_of(direction):
    """The name of the coordinate that grows along a direction, `None` if none does."""
    k = np.abs(direction).argmax()
    return "−" * bool(direction[k] < 0) + "xyz"[k] if abs(direction[k]) > NEARLY else None


def label_along(direction):
    """The title of an axis of paper: a coordinate of the scene, or the distance along the contact in a direction."""
    if name := coordinate_of(direction):
        return Label(name)
    components = ", ".join(f"{round(component, 2) + 0.0:g}" for component in direction)
    return Label("distance along the contact", f"direction ({components})")
