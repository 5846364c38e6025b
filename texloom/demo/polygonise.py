"""A triangle mesh around a signed distance: surface nets, then even triangles.

One vertex a lattice cell that the surface crosses, one quad a crossed lattice edge (Gibson 1998); vertices then drift
to the middle of their neighbours and back onto the surface, which leaves triangles close to equilateral.
"""

import numpy as np
from jaxtyping import Float64, Int32

from texloom.demo.shapes import Shape
from texloom.mesh.mesh import Mesh


def polygonise(shape: Shape, *, low: np.ndarray, high: np.ndarray, step: float, relax: int = 8) -> Mesh:
    """The surface where ``shape`` is zero, sampled every ``step``; the box must hold it with room to spare."""
    counts = np.ceil((np.asarray(high) - low) / step).astype(int) + 1
    lattice = np.stack(np.meshgrid(*(np.arange(n) for n in counts), indexing="ij"), -1) * step + low
    values = shape(lattice)
    cell_vertex, vertices = _net_vertices(values, np.asarray(low, np.float64), step)
    faces = _net_faces(values, cell_vertex, vertices)
    for _ in range(relax):
        vertices = _settle(_spread(vertices, faces), shape, step)
    return Mesh(vertices, faces)


def _net_vertices(
    values: np.ndarray, low: np.ndarray, step: float
) -> tuple[np.ndarray, Float64[np.ndarray, "vertex 3"]]:
    """Vertex number of every cell (-1: none), and vertices at the mean of the crossings of the cell's twelve edges."""
    counts = np.array(values.shape) - 1
    total, crossings = np.zeros((*counts, 3)), np.zeros((*counts, 1))
    for axis in range(3):
        others = [a for a in range(3) if a != axis]
        first, second = np.delete(values, -1, axis), np.delete(values, 0, axis)
        crossed = (first < 0) != (second < 0)
        place = np.stack(np.meshgrid(*(np.arange(n) for n in first.shape), indexing="ij"), -1).astype(np.float64)
        place[..., axis] += np.where(crossed, first / np.where(crossed, first - second, 1.0), 0.0)
        for i in (0, 1):
            for j in (0, 1):
                window = [slice(None)] * 3
                window[others[0]] = slice(i, i + counts[others[0]])
                window[others[1]] = slice(j, j + counts[others[1]])
                here = crossed[tuple(window)][..., None]
                total += np.where(here, place[tuple(window)], 0.0)
                crossings += here
    active = crossings[..., 0] > 0
    cell_vertex = np.where(active, np.cumsum(active).reshape(active.shape) - 1, -1)
    return cell_vertex, total[active] / crossings[active] * step + low


def _net_faces(values: np.ndarray, cell_vertex: np.ndarray, vertices: np.ndarray) -> Int32[np.ndarray, "face 3"]:
    """Two triangles for every crossed lattice edge, cut along the shorter diagonal, facing outwards."""
    quads = []
    for axis in range(3):
        i, j = (axis + 1) % 3, (axis + 2) % 3
        first, second = np.delete(values, -1, axis), np.delete(values, 0, axis)
        edge = np.argwhere((first < 0) != (second < 0))
        leaving = first[tuple(edge.T)] < 0  # the lattice edge runs from inside to outside
        around = []
        for back_i, back_j in ((1, 1), (0, 1), (0, 0), (1, 0)):
            cell = edge.copy()
            cell[:, i] -= back_i
            cell[:, j] -= back_j
            around.append(cell_vertex[tuple(cell.T)])
        quad = np.stack(around, -1)
        quads.append(np.where(leaving[:, None], quad, quad[:, ::-1]))
    quad = np.concatenate(quads)
    corner = vertices[quad]
    across = np.linalg.norm(corner[:, 0] - corner[:, 2], axis=-1) <= np.linalg.norm(
        corner[:, 1] - corner[:, 3], axis=-1
    )
    split = np.where(across[:, None], quad, np.roll(quad, -1, axis=1))
    return np.concatenate([split[:, [0, 1, 2]], split[:, [0, 2, 3]]]).astype(np.int32)


def _spread(vertices: np.ndarray, faces: np.ndarray) -> np.ndarray:
    """Each vertex half-way to the mean of its neighbours."""
    start, end = np.concatenate([faces, np.roll(faces, -1, 1)], 1).reshape(-1, 2, 3).transpose(1, 0, 2).reshape(2, -1)
    count = np.bincount(start, minlength=len(vertices))[:, None]
    mean = np.stack([np.bincount(start, vertices[end, a], minlength=len(vertices)) for a in range(3)], -1) / count
    return 0.5 * (vertices + mean)


def _settle(vertices: np.ndarray, shape: Shape, step: float) -> np.ndarray:
    """Vertices back on the surface: two Newton steps along the gradient."""
    small = 0.05 * step
    for _ in range(2):
        gradient = np.stack([shape(vertices + small * e) - shape(vertices - small * e) for e in np.eye(3)], -1)
        gradient /= 2 * small
        squared = np.maximum((gradient**2).sum(-1, keepdims=True), 0.25)
        vertices = vertices - shape(vertices)[..., None] * gradient / squared
    return vertices
