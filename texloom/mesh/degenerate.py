"""Faces without area, taken out so that the surface stays closed."""

import numpy as np
from jaxtyping import Bool, Float64, Int32

from texloom.mesh.mesh import Mesh

_THINNEST = 1e-8  # height over the longest side below which a face has no area
_MOST_PASSES = 30  # one suffices unless faces without area lie side by side


def has_no_area(mesh: Mesh) -> Bool[np.ndarray, "face"]:
    """Whether a face's height is next to nothing against its longest side."""
    squared = [np.einsum("ij,ij->i", side, side) for side in mesh.sides]
    return 2 * mesh.face_areas <= _THINNEST * np.maximum(np.maximum(squared[0], squared[1]), squared[2])


def needles(
    vertices: Float64[np.ndarray, "vertex 3"], faces: Int32[np.ndarray, "face 3"]
) -> Int32[np.ndarray, "side 2"]:
    """The two ends, lower vertex first, of every side that is next to nothing against its face's longest side."""
    corners = vertices[faces]
    lengths = np.linalg.norm(np.roll(corners, -1, axis=1) - corners, axis=2)
    face, side = np.nonzero(lengths <= _THINNEST * lengths.max(axis=1, keepdims=True))
    return np.sort(np.stack([faces[face, side], faces[face, (side + 1) % 3]], axis=1), axis=1)


def flatten_away(
    vertices: Float64[np.ndarray, "vertex 3"],
    faces: Int32[np.ndarray, "face 3"],
    corners: Int32[np.ndarray, "face 3"],
    origins: Int32[np.ndarray, "face"],
) -> Bool[np.ndarray, "face"]:
    """Take out faces without area, writing to the arrays; returns the faces to keep.

    Such a face is a line with a vertex on its longest side. That vertex is given to the neighbour across the side,
    which is cut in two there: a flip of the edge, the face without area standing in for one half. So no crack opens,
    as it would if the face were dropped. Faces with no neighbour there are dropped.
    """
    keep = np.ones(len(faces), bool)
    for _ in range(_MOST_PASSES):
        flat = has_no_area(Mesh(vertices, faces)) & keep
        if not flat.any():
            break
        if not _flip_pass(vertices, faces, corners, origins, keep, flat):
            break
    return keep & ~has_no_area(Mesh(vertices, faces))


def _flip_pass(
    vertices: np.ndarray,
    faces: np.ndarray,
    corners: np.ndarray,
    origins: np.ndarray,
    keep: np.ndarray,
    flat: np.ndarray,
) -> bool:
    """Flip or drop each flat face once, if the neighbour across its longest side is not flat itself."""
    kept = np.flatnonzero(keep)
    twins = Mesh(vertices, faces[kept]).twins
    place = np.cumsum(keep) - 1
    touched = np.zeros(len(faces), bool)
    for face in np.flatnonzero(flat):
        side = _longest_side(vertices[faces[face]])
        twin = int(twins[3 * place[face] + side])
        if twin < 0:
            keep[face] = False
            touched[face] = True
            continue
        neighbour, back = int(kept[twin // 3]), twin % 3
        if flat[neighbour] or touched[neighbour] or touched[face]:
            continue
        for values in (faces, corners):
            apex = values[face, (side + 2) % 3]
            b, a, d = values[neighbour, back], values[neighbour, (back + 1) % 3], values[neighbour, (back + 2) % 3]
            values[face] = apex, a, d
            values[neighbour] = b, apex, d
        origins[face] = origins[neighbour]
        touched[face] = touched[neighbour] = True
    return bool(touched.any())


def _longest_side(corners: np.ndarray) -> int:
    """Which of the three sides, from its tail corner, is longest."""
    return int(np.argmax(np.linalg.norm(np.roll(corners, -1, axis=0) - corners, axis=1)))
