"""Where points lie on a mesh."""

import numpy as np
from jaxtyping import Float, Float64, Int32

from texloom.mesh.mesh import Mesh


def closest_points(
    mesh: Mesh, points: Float[np.ndarray, "point 3"]
) -> tuple[Int32[np.ndarray, "point"], Float64[np.ndarray, "point 3"]]:
    """The face nearest to each point, and the barycentric coordinates of the nearest place in it.

    On an edge or a vertex it is one of the faces that meet there.
    """
    import igl

    origin = mesh.vertices.mean(axis=0)  # a small mesh far away would lose its digits in the squares
    vertices = mesh.vertices - origin
    wanted = np.ascontiguousarray(np.asarray(points, np.float64).reshape(-1, 3) - origin)
    _, faces, places = igl.point_mesh_squared_distance(wanted, vertices, mesh.faces.astype(np.int64))
    faces = np.asarray(faces, np.int32).reshape(-1)
    return faces, barycentric(vertices[mesh.faces[faces]], np.asarray(places).reshape(-1, 3))


def barycentric(
    corners: Float[np.ndarray, "point 3 3"], places: Float[np.ndarray, "point 3"]
) -> Float64[np.ndarray, "point 3"]:
    """Barycentric coordinates of places in triangles, moved to the nearest of the triangle's own, summing to 1."""
    a, b, c = (corners[:, k] for k in range(3))
    normals = np.cross(b - a, c - a)
    opposite = [np.cross(c - b, places - b), np.cross(a - c, places - c), np.cross(b - a, places - a)]
    weights = np.stack([np.einsum("ij,ij->i", normals, part) for part in opposite], axis=1)
    weights = np.maximum(weights, 0.0)
    return weights / np.maximum(weights.sum(axis=1, keepdims=True), np.finfo(np.float64).tiny)
