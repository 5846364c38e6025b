"""Analytic meshes by class, for everybody's tests: small, exact, and named for what they are."""

import numpy as np
from numpy import ndarray

from texloom.mesh.mesh import Mesh


def as_mesh(vertices: object, faces: object) -> Mesh:
    """A mesh from anything array-like."""
    return Mesh(np.ascontiguousarray(vertices, np.float64), np.ascontiguousarray(faces, np.int32))


def flat_square(n: int = 8, size: float = 1.0) -> Mesh:
    """``n × n`` cells of two triangles in the plane z = 0, normal up; vertex ``i * (n + 1) + j`` has y = i, x = j."""
    y, x = np.meshgrid(np.linspace(0, size, n + 1), np.linspace(0, size, n + 1), indexing="ij")
    return as_mesh(np.stack([x, y, np.zeros_like(x)], axis=-1).reshape(-1, 3), _lattice(n, n, False, False))


def torus(around: int = 32, across: int = 16, radius: float = 1.0, tube: float = 0.4) -> Mesh:
    """A torus around the z axis, normals outward."""
    u, v = np.meshgrid(_circle(around), _circle(across), indexing="ij")
    ring = radius + tube * np.cos(v)
    points = np.stack([ring * np.cos(u), ring * np.sin(u), tube * np.sin(v)], axis=-1)
    return as_mesh(points.reshape(-1, 3), _lattice(around, across, True, True)[:, ::-1])


def sphere(subdivisions: int = 3, radius: float = 1.0) -> Mesh:
    """An octahedron split ``subdivisions`` times, its vertices on the sphere; normals outward."""
    mesh = octahedron()
    vertices, faces = mesh.vertices, mesh.faces
    for _ in range(subdivisions):
        vertices, faces = _split_in_four(vertices, faces)
        vertices = vertices / np.linalg.norm(vertices, axis=1, keepdims=True)
    return as_mesh(vertices * radius, faces)


def octahedron() -> Mesh:
    """Six vertices on the axes, eight equal faces."""
    vertices = [[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]]
    faces = [[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4], [2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5]]
    return as_mesh(vertices, faces)


def tetrahedron() -> Mesh:
    """The smallest closed mesh."""
    return as_mesh([[1, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]], [[0, 1, 2], [0, 2, 3], [0, 3, 1], [1, 3, 2]])


def cone(around: int = 24, rings: int = 8, radius: float = 1.0, height: float = 1.0) -> Mesh:
    """An open cone, apex (vertex 0) up at z = height, rim on z = 0; unrolls to a sector of angle 2π·radius/slant."""
    angle, ring = _circle(around), np.arange(1, rings + 1) / rings
    points = np.stack(
        [
            np.outer(ring, np.cos(angle)) * radius,
            np.outer(ring, np.sin(angle)) * radius,
            np.repeat(height * (1 - ring)[:, None], around, axis=1),
        ],
        axis=-1,
    )
    faces = _lattice(rings - 1, around, False, True)[:, ::-1] + 1
    first = np.arange(around)
    fan = np.stack([np.zeros_like(first), 1 + first, 1 + (first + 1) % around], axis=1)
    return as_mesh(np.concatenate([[[0, 0, height]], points.reshape(-1, 3)]), np.concatenate([fan, faces]))


def cylinder(around: int = 24, rings: int = 8, radius: float = 1.0, height: float = 2.0) -> Mesh:
    """An open cylinder around the z axis from z = 0 to z = height, normals outward."""
    z, angle = np.meshgrid(np.linspace(0, height, rings + 1), _circle(around), indexing="ij")
    points = np.stack([radius * np.cos(angle), radius * np.sin(angle), z], axis=-1)
    return as_mesh(points.reshape(-1, 3), _lattice(rings, around, False, True))


def single_triangle() -> Mesh:
    """One face, three boundary edges."""
    return as_mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])


def slivers(n: int = 6, thinness: float = 1e-3) -> Mesh:
    """A square squeezed to a ribbon: long thin triangles, angles near 0 and π/2."""
    mesh = flat_square(n)
    return as_mesh(mesh.vertices * [1, thinness, 1], mesh.faces)


def obtuse() -> Mesh:
    """A pyramid so flat that its cotangents turn negative, with one long side."""
    return as_mesh(
        [[0, 0, 0], [4, 0, 0], [4, 1, 0], [0, 1, 0], [3.5, 0.5, 0.05]], [[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]]
    )


def two_parts() -> Mesh:
    """A sphere and a square beside it, not connected."""
    return joined(sphere(2), shifted(flat_square(4), (3, 0, 0)))


def tiny_far() -> Mesh:
    """A sphere of radius 1e-6 at distance 1.7e3 from the origin."""
    return shifted(sphere(2, radius=1e-6), (1e3, 1e3, 1e3))


def shifted(mesh: Mesh, offset: tuple[float, float, float]) -> Mesh:
    """The mesh moved by ``offset``."""
    return as_mesh(mesh.vertices + offset, mesh.faces)


def joined(*meshes: Mesh) -> Mesh:
    """Several meshes as one, not connected."""
    starts = np.cumsum([0, *(len(mesh.vertices) for mesh in meshes)])
    faces = [mesh.faces + start for mesh, start in zip(meshes, starts[:-1], strict=True)]
    return as_mesh(np.concatenate([mesh.vertices for mesh in meshes]), np.concatenate(faces))


def closed_meshes() -> dict[str, Mesh]:
    """No boundary, one part."""
    return {"sphere": sphere(2), "torus": torus(24, 12), "octahedron": octahedron(), "tetrahedron": tetrahedron()}


def boundary_meshes() -> dict[str, Mesh]:
    """With a boundary, one part."""
    return {"flat_square": flat_square(6), "cone": cone(16, 5), "cylinder": cylinder(16, 5)}


def awkward_meshes() -> dict[str, Mesh]:
    """Manifold, but hard on numerics or assumptions."""
    return {
        "single_triangle": single_triangle(),
        "slivers": slivers(),
        "obtuse": obtuse(),
        "two_parts": two_parts(),
        "tiny_far": tiny_far(),
    }


def all_meshes() -> dict[str, Mesh]:
    """Every class together."""
    return closed_meshes() | boundary_meshes() | awkward_meshes()


def _circle(count: int) -> ndarray:
    return 2 * np.pi * np.arange(count) / count


def _lattice(rows: int, columns: int, wrap_rows: bool, wrap_columns: bool) -> ndarray:
    """Two triangles a cell, counter-clockwise with columns to the right and rows up."""
    row_count, column_count = rows + (not wrap_rows), columns + (not wrap_columns)
    i, j = (axis.ravel() for axis in np.meshgrid(np.arange(rows), np.arange(columns), indexing="ij"))
    below, above = i * column_count, (i + 1) % row_count * column_count
    left, right = j, (j + 1) % column_count
    a, b, c, d = below + left, below + right, above + right, above + left
    return np.stack([np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1)], axis=1).reshape(-1, 3)


def _split_in_four(vertices: ndarray, faces: ndarray) -> tuple[ndarray, ndarray]:
    """Midpoint subdivision."""
    ends = np.sort(np.stack([faces, np.roll(faces, -1, axis=1)], axis=-1).reshape(-1, 2), axis=1)
    edges, inverse = np.unique(ends, axis=0, return_inverse=True)
    middle = len(vertices) + inverse.reshape(-1, 3)
    a, b, c = faces.T
    ab, bc, ca = middle.T
    split = np.stack([[a, ab, ca], [b, bc, ab], [c, ca, bc], [ab, bc, ca]])  # (child, corner, face)
    return np.concatenate([vertices, vertices[edges].mean(axis=1)]), split.transpose(2, 0, 1).reshape(-1, 3)
