"""Small meshes and surfaces that the output tests share."""

import numpy as np

from texloom.mesh.mesh import Mesh
from texloom.output.sites import SurfaceSites


def grid_mesh(cells: int, side: float = 1.0) -> tuple[Mesh, np.ndarray]:
    """A flat square of ``2 cells²`` faces in the plane z = 0, and corner UVs that fill the unit square."""
    across = np.linspace(0, side, cells + 1)
    x, y = np.meshgrid(across, across)
    vertices = np.stack([x.ravel(), y.ravel(), np.zeros(x.size)], axis=1)
    a = (np.arange(cells)[:, None] * (cells + 1) + np.arange(cells)).ravel()
    b, c, d = a + 1, a + cells + 2, a + cells + 1
    faces = np.stack([np.stack([a, b, c], 1), np.stack([a, c, d], 1)], 1).reshape(-1, 3).astype(np.int32)
    return Mesh(vertices, faces), (vertices[faces][..., :2] / side).astype(np.float32)


def sphere(rings: int = 12) -> Mesh:
    """A closed sphere of radius 1."""
    turn, rise = np.arange(2 * rings) * np.pi / rings, np.linspace(-np.pi / 2, np.pi / 2, rings + 1)[1:-1]
    body = [[np.cos(r) * np.sin(t), np.sin(r), np.cos(r) * np.cos(t)] for r in rise for t in turn]
    vertices = np.array([*body, [0, -1, 0], [0, 1, 0]])
    n, south, north = 2 * rings, len(body), len(body) + 1
    faces = []
    for ring in range(rings - 2):
        for i in range(n):
            a, b = ring * n + i, ring * n + (i + 1) % n
            faces += [[a, b, b + n], [a, b + n, a + n]]
    top = (rings - 2) * n
    for i in range(n):
        faces += [[south, (i + 1) % n, i], [north, top + i, top + (i + 1) % n]]
    return Mesh(vertices, np.array(faces, np.int32))


def flat_surface(mesh: Mesh, texel: float, turn: float = 0.0) -> SurfaceSites:
    """Sites on a mesh in the plane, all with one direction, ``turn`` from +x."""
    count = len(mesh.vertices)
    direction = np.tile([np.cos(turn), np.sin(turn), 0.0], (count, 1))
    return SurfaceSites(
        vertices=mesh.vertices,
        faces=mesh.faces,
        direction=direction,
        normal=np.tile([0.0, 0.0, 1.0], (count, 1)),
        texel=texel,
    )
