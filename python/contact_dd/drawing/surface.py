"""The surface of bodies in space: faces of one cell only, their normals and their nodes."""

import numpy as np

# Faces of VTK's cells around their corners, with the nodes on edges where there are some.
TETRAHEDRON = [(0, 2, 1), (0, 1, 3), (1, 2, 3), (0, 3, 2)]
HEXAHEDRON = [(0, 3, 2, 1), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7), (4, 5, 6, 7)]
EDGES = {
    4: {(0, 1): 4, (1, 2): 5, (0, 2): 6, (0, 3): 7, (1, 3): 8, (2, 3): 9},
    8: {
        (0, 1): 8, (1, 2): 9, (2, 3): 10, (0, 3): 11, (4, 5): 12, (5, 6): 13, (6, 7): 14, (4, 7): 15,
        (0, 4): 16, (1, 5): 17, (2, 6): 18, (3, 7): 19,
    },
}
# The one with nodes in the middle of faces.
HEXAHEDRON27 = 29
# Of its cells the node in the middle of each face of HEXAHEDRON.
CENTRES = [24, 22, 21, 23, 20, 25]
CELLS = {10: (4, False), 12: (8, False), 24: (4, True), 25: (8, True), 29: (8, True)}


def outline(kind, face):
    """The nodes around a face, those on its edges among them."""
    corners, is_quadratic = CELLS[kind]
    nodes = []
    for a, b in zip(face, face[1:] + face[:1]):
        nodes.append(a)
        if is_quadratic:
            nodes.append(EDGES[corners][min(a, b), max(a, b)])
    return nodes


def surface(cells, tags):
    """The nodes around every face of one cell only."""
    faces, keys = [], []
    for kind, _, nodes in cells:
        for face in TETRAHEDRON if CELLS[kind][0] == 4 else HEXAHEDRON:
            faces.extend(nodes[:, outline(kind, face)])
            corners = np.sort(tags[nodes[:, face]], axis=1)
            keys.append(corners[:, :3])
    _, first, count = np.unique(np.concatenate(keys), axis=0, return_index=True, return_counts=True)
    return [faces[k] for k in first[count == 1]]


def unit_normal(polygon):
    normal = area(polygon)
    return normal / np.linalg.norm(normal)


def area(polygon):
    """The area of a polygon times its normal."""
    arms = polygon[1:] - polygon[0]
    return np.cross(arms[:-1], arms[1:]).sum(axis=0) / 2


def mean_normals(result, faces):
    """The mean of the outward normals of the faces around each node on the surface, 0 elsewhere."""
    normals, count = np.zeros_like(result.points), np.zeros(len(result.points))
    one = np.searchsorted(result.nodes, result.nodes)
    for face in faces:
        normals[one[face]] += unit_normal(result.points[face])
        count[one[face]] += 1
    return normals / np.maximum(count, 1)[:, None]


def on_surface(result, faces):
    """The rows of nodes on the surface, those in the middle of faces among them."""
    found = [np.concatenate(faces)]
    for cells in result.cells:
        if cells.kind == HEXAHEDRON27:
            nodes, count = np.unique(result.nodes[cells.nodes[:, 20:26]], return_counts=True)
            found.append(np.searchsorted(result.nodes, nodes[count == 1]))
    return np.unique(np.concatenate(found))


def face_centres(result, tags):
    """Tags of nodes in the middle of faces that are among these, by the tags of the face's corners in their order."""
    found = {}
    for cells in result.cells:
        if cells.kind == HEXAHEDRON27:
            for face, centre in zip(HEXAHEDRON, CENTRES, strict=True):
                nodes = result.nodes[cells.nodes[:, [*face, centre]]]
                meant = nodes[np.isin(nodes[:, 4], tags)]
                found.update(zip(map(tuple, np.sort(meant[:, :4], axis=1).tolist()), meant[:, 4].tolist()))
    return found


def corners_of(face):
    """The corners among the nodes around a face."""
    return face if len(face) < 6 else face[::2]
