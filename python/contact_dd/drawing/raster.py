"""Faces in space as a picture, by samples of them and a depth buffer: hidden parts aren't drawn, curved faces are
curved, and values vary within them. A renderer of OpenGL needs libraries that clusters often lack."""

from dataclasses import dataclass

import numpy as np

from contact_dd.drawing import shapes

# Pixels in one direction for each one of the picture.
OVERSAMPLED = 2
# Samples of a face over its length in pixels, which leave no holes.
DENSITY = 1.35
# Samples that are looked at together.
AT_ONCE = 1_500_000
# Lines lie before faces by this part of the picture.
BEFORE = 0.004
# A step in depth that is the outline of something, over the size of the picture.
STEP = 0.03
# Cosine of the angle between two faces beyond which their edge is one of the body.
SHARP = 0.82
# Light of faces that are seen from the side.
SHADE = 0.72


@dataclass
class Camera:
    """Position of the eye: above the horizon and around the vertical (degrees), far away."""

    elevation: float
    azimuth: float

    def axes(self):
        """To the right, upwards, and to the eye."""
        e, a = np.radians([self.elevation, self.azimuth])
        eye = np.array([np.cos(e) * np.cos(a), np.cos(e) * np.sin(a), np.sin(e)])
        right = np.array([-np.sin(a), np.cos(a), 0.0])
        return np.stack([right, np.cross(eye, right), eye])


@dataclass
class Faces:
    """Faces of one kind: the rows of their nodes, corners first."""

    nodes: np.ndarray
    shape: object
    corners: int

    def samples(self, n):
        """Places in the reference face, n along an edge."""
        s, t = (grid.ravel() for grid in np.meshgrid(*2 * [np.linspace(0, 1, n)]))
        inside = s + t <= 1 + 1e-12 if self.corners == 3 else slice(None)
        return self.shape(np.stack([s[inside], t[inside]], axis=1))

    def edges(self):
        """The nodes of each face's edges: both ends, and the middle, an end where there is none; (faces, edges, 3)."""
        k = np.arange(self.corners)
        middle = self.corners + k if self.nodes.shape[1] > self.corners else k
        return self.nodes[:, np.stack([k, (k + 1) % self.corners, middle], axis=1)]


    def speeds(self, points):
        """The largest derivative of each face's edges: where the middle isn't half-way they are faster at one end."""
        a, b, m = (points[self.edges()[..., k]] for k in range(3))
        if self.nodes.shape[1] == self.corners:
            m = (a + b) / 2
        ends = np.linalg.norm(4 * m - 3 * a - b, axis=2), np.linalg.norm(4 * m - a - 3 * b, axis=2)
        return np.maximum(*ends).max(axis=1)


SHAPES = {3: (shapes.triangle3, 3), 6: (shapes.triangle6, 3), 4: (shapes.quad4, 4), 8: (shapes.quad8, 4)}


def grouped(faces):
    """Faces, each the nodes around it, by their kinds, and which ones each kind has."""
    sizes = np.array([len(face) for face in faces])
    for size in np.unique(sizes):
        members = np.flatnonzero(sizes == size)
        nodes = np.array([faces[k] for k in members])
        # Around a quadratic face corners and middles take turns.
        if size in (6, 8):
            nodes = np.concatenate([nodes[:, ::2], nodes[:, 1::2]], axis=1)
        yield Faces(nodes, *SHAPES[size]), members


class Raster:
    """A picture of faces: the one nearest to the eye at every pixel."""

    def __init__(self, camera, points, width):
        self.frame = camera.axes()
        on_paper = points @ self.frame.T
        self.low = on_paper.min(axis=0)
        self.size = np.ptp(on_paper, axis=0)
        self.points = on_paper
        margin = 4 * OVERSAMPLED
        self.scale = (width * OVERSAMPLED - 2 * margin) / max(self.size[0], 0.8 * self.size[1])
        shape = np.ceil(self.size[1::-1] * self.scale).astype(int) + 2 * margin
        self.shape = tuple(shape + shape % OVERSAMPLED)
        self.margin = margin
        self.depth = np.full(self.shape, -np.inf)
        self.value = np.full(self.shape, np.nan)
        self.light = np.ones(self.shape)
        self.lines = np.zeros(self.shape)

    @property
    def extent(self):
        """Left, right, below, above on paper, in the unit of length."""
        left, below = self.low[:2] - self.margin / self.scale
        return left, left + self.shape[1] / self.scale, below, below + self.shape[0] / self.scale

    def pixels(self, at):
        """Rows and columns, flat, of places on paper; those outside of the picture at its rim."""
        column, row = ((at[..., k] - self.low[k]) * self.scale + self.margin for k in (0, 1))
        row = np.clip(row.astype(int), 0, self.shape[0] - 1)
        return row * self.shape[1] + np.clip(column.astype(int), 0, self.shape[1] - 1)

    def draw(self, faces, values):
        """Draws faces by the values of their nodes."""
        for kind, _ in grouped(faces):
            corners = self.points[kind.nodes[:, : kind.corners]]
            needed = np.maximum(np.ceil(DENSITY * self.scale * kind.speeds(self.points[:, :2])) + 1, 2)
            steps = rounded_up(needed)
            normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
            normal /= np.maximum(np.linalg.norm(normal, axis=1), 1e-300)[:, None]
            light = SHADE + (1 - SHADE) * np.abs(normal @ [-0.3, 0.4, 0.87])
            for n in np.unique(steps):
                weights = kind.samples(int(n))
                members = np.flatnonzero(steps == n)
                for some in np.array_split(members, -(-len(members) * len(weights) // AT_ONCE)):
                    self._sample(kind.nodes[some], weights, values, light[some])

    def _sample(self, nodes, weights, values, light):
        at = np.einsum("sk,fkd->fsd", weights, self.points[nodes])
        value = np.einsum("sk,fk->fs", weights, values[nodes]).ravel()
        pixel, depth = self.pixels(at).ravel(), at[..., 2].ravel()
        np.maximum.at(self.depth.reshape(-1), pixel, depth)
        nearest = depth >= self.depth.reshape(-1)[pixel]
        self.value.reshape(-1)[pixel[nearest]] = value[nearest]
        self.light.reshape(-1)[pixel[nearest]] = np.repeat(light, len(weights))[nearest]

    def line(self, edges, strength, thickness=1):
        """Draws edges (ends and middle) where nothing is before them."""
        if len(edges) == 0:
            return
        a, b, m = (self.points[edges[:, k]] for k in range(3))
        m = np.where((edges[:, 2] == edges[:, 0])[:, None], (a + b) / 2, m)
        longest = np.linalg.norm((b - a)[:, :2], axis=1) * self.scale
        steps = rounded_up(np.maximum(1.5 * longest, 2))
        for n in np.unique(steps):
            of = steps == n
            s = np.linspace(0, 1, int(n))[:, None, None]
            at = (1 - s) * (1 - 2 * s) * a[of] + s * (2 * s - 1) * b[of] + 4 * s * (1 - s) * m[of]
            at = at.reshape(-1, 3)
            pixel = self.pixels(at)
            seen = at[:, 2] + BEFORE * max(self.size) >= self.depth.reshape(-1)[pixel]
            row, column = np.divmod(pixel[seen], self.shape[1])
            for i in range(thickness):
                for j in range(thickness):
                    at_line = np.minimum(row + i, self.shape[0] - 1), np.minimum(column + j, self.shape[1] - 1)
                    self.lines[at_line] = np.maximum(self.lines[at_line], strength)

    def outline(self, strength=1.0):
        """Draws outlines: edges of parts in front of others, or of the background."""
        is_there = np.isfinite(self.depth)
        depth = np.where(is_there, self.depth, self.depth[is_there].min(initial=0.0) - max(self.size))
        step = STEP * max(self.size)
        for axis in (0, 1):
            is_step = np.abs(np.diff(depth, axis=axis)) > step
            here = [slice(None)] * 2
            for part in (slice(None, -1), slice(1, None)):
                here[axis] = part
                self.lines[tuple(here)] = np.maximum(self.lines[tuple(here)], strength * is_step)

    def cover(self):
        """The share of every pixel of the picture that faces cover."""
        return self._coarse(np.isfinite(self.value)[..., None])

    def strength(self):
        """The strength of lines at every pixel of the picture."""
        return self._coarse(self.lines[..., None])

    def _coarse(self, picture):
        rows, columns = (side // OVERSAMPLED for side in self.shape)
        return picture.reshape(rows, OVERSAMPLED, columns, OVERSAMPLED, -1).mean(axis=(1, 3))

    def image(self, colours, alpha=1.0):
        """The picture in red, green, blue on white."""
        is_there = np.isfinite(self.value)
        picture = np.ones((*self.shape, 3))
        shaded = colours.to_rgba(self.value[is_there])[:, :3] * self.light[is_there][:, None]
        picture[is_there] = 1 - alpha * (1 - shaded)
        picture *= (1 - self.lines)[..., None]
        return self._coarse(picture)


def rounded_up(counts):
    """Counts of samples, few different ones."""
    return np.ceil(1.25 ** np.ceil(np.log(counts) / np.log(1.25)))


def edges_of(faces, points):
    """The edges of faces, ends and middle: those of the bodies, sharp or of one face only, and those of the mesh."""
    edges, normals = [], []
    for kind, _ in grouped(faces):
        found = kind.edges()
        corners = points[kind.nodes[:, : kind.corners]]
        # The normal beside each edge, which bends with the face.
        normal = np.cross(np.roll(corners, -1, axis=1) - corners, np.roll(corners, 1, axis=1) - corners)
        normal = normal + np.roll(normal, -1, axis=1)
        normals.append(normal.reshape(-1, 3))
        edges.append(found.reshape(-1, 3))
    edges, normals = np.concatenate(edges), np.concatenate(normals)
    normals /= np.maximum(np.linalg.norm(normals, axis=1), 1e-300)[:, None]
    order = np.lexsort(np.sort(edges[:, :2], axis=1).T)
    edges, normals = edges[order], normals[order]
    keys = np.sort(edges[:, :2], axis=1)
    same = (keys[1:] == keys[:-1]).all(axis=1)
    is_first = np.append(True, ~same)
    smooth = np.append(same & ((normals[1:] * normals[:-1]).sum(axis=1) > SHARP), False)
    return edges[is_first & ~smooth], edges[is_first & smooth]
