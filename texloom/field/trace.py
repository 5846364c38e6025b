"""Integral curves of a direction field over intrinsic triangles: each laid flat in 2-D, glued along its edges.

A mesh, a plane and a torus become the same thing here, a ``Flow``; nothing that walks it knows which it was.
"""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Complex, Float, Float32, Int32

from texloom.field.direction import DirectionField
from texloom.kernels.frames import flatten_triangles, pack_records
from texloom.kernels.launch import launch
from texloom.kernels.trace import trace_lines
from texloom.mesh.mesh import Mesh


@dataclass(frozen=True, eq=False)
class Flow:
    """Triangles between sites, with a direction field of symmetry ``order`` and the length of a texel.

    ``record`` is what the kernels read of a triangle (``texloom.kernels.trace``): its corners in its own 2-D frame, the
    field's power and the world length of a texel at them, the rotations into its neighbours' frames. ``position``
    places sites in space (on a torus one of many places, ``period`` apart; 0 is not periodic), only to compare nearby
    points.
    """

    order: int
    faces: Int32[np.ndarray, "face 3"]
    twin: Int32[np.ndarray, "face 3"]
    record: Float32[np.ndarray, "face 24"]
    position: Float32[np.ndarray, "site 3"]
    period: tuple[float, float, float] = (0.0, 0.0, 0.0)

    @property
    def power(self) -> Complex[np.ndarray, "face 3"]:
        """The field's power at the corners of each face, in the face's frame."""
        return self.record[:, 3:9].copy().view(np.complex64)


def surface_flow(mesh: Mesh, field: DirectionField, texel: Float[np.ndarray, "vertex"]) -> Flow:
    """The flow of a field on a mesh; ``texel`` is the world length of a texel at every vertex."""
    corners = np.empty((len(mesh.faces), 3))
    launch(flatten_triangles, len(corners), inputs=[mesh.vertices, mesh.faces], outputs=[corners])
    twin = mesh.twins.reshape(-1, 3)
    return Flow(
        order=field.order,
        faces=mesh.faces,
        twin=twin,
        record=_pack(corners, field.power, texel, mesh.faces, twin),
        position=(mesh.vertices - mesh.vertices.mean(axis=0)).astype(np.float32),
    )


def planar_flow(
    direction: Complex[np.ndarray, "row column"], texel: Float[np.ndarray, "row column"], *, order: int, wrap: bool
) -> Flow:
    """The flow of a planar field on a lattice of sites one unit apart, two triangles a cell.

    ``direction`` is a complex number per site, real along the columns, imaginary up the rows (against the row index).
    """
    rows, columns = direction.shape
    row, column = np.meshgrid(np.arange(rows - (not wrap)), np.arange(columns - (not wrap)), indexing="ij")

    def site(down: int, right: int) -> np.ndarray:
        return ((row + down) % rows * columns + (column + right) % columns).ravel()

    top_left, bottom_left, bottom_right, top_right = site(0, 0), site(1, 0), site(1, 1), site(0, 1)
    lower = np.stack([top_left, bottom_left, bottom_right], axis=1)
    upper = np.stack([top_left, bottom_right, top_right], axis=1)
    faces = np.stack([lower, upper], axis=1).reshape(-1, 3).astype(np.int32)

    # Frames: the lower triangle's first axis points down, the upper one's along the diagonal
    root = np.sqrt(0.5)
    corners = np.tile([[1.0, 1.0, 1.0], [2 * root, root, root]], (row.size, 1))
    axis = np.tile([-1j, root - 1j * root], row.size)
    power = (direction.ravel()[faces] * np.conj(axis)[:, None]) ** order
    twin = _lattice_twins(*row.shape, wrap=wrap)
    place = np.stack(np.meshgrid(np.arange(columns), -np.arange(rows), indexing="xy"), axis=-1).reshape(-1, 2)
    return Flow(
        order=order,
        faces=faces,
        twin=twin,
        record=_pack(corners, power, texel.ravel(), faces, twin),
        position=np.pad(place, ((0, 0), (0, 1))).astype(np.float32),
        period=(float(columns), float(rows), 0.0) if wrap else (0.0, 0.0, 0.0),
    )


@dataclass(frozen=True, eq=False)
class Samples:
    """Points on a flow, written in place by tracing: face (-1: none), barycentric place, the field's direction there.

    ``heading`` is a unit complex number in the face's frame: of the field's directions, the one being followed.
    """

    face: Int32[np.ndarray, "sample"]
    place: Float32[np.ndarray, "sample 3"]
    heading: Float32[np.ndarray, "sample 2"]

    @classmethod
    def empty(cls, count: int) -> "Samples":
        """All of them nowhere."""
        return cls(np.full(count, -1, np.int32), np.zeros((count, 3), np.float32), np.zeros((count, 2), np.float32))


def starts(flow: Flow) -> Samples:
    """A sample on every site, along the field's principal direction in the first face around it.

    A site without faces, or where the field vanishes, has none.
    """
    site_count = len(flow.position)
    corner = np.full(site_count, -1, np.int64)
    corner[flow.faces.ravel()[::-1]] = np.arange(flow.faces.size)[::-1]
    power = flow.power.ravel()[corner]
    samples = Samples.empty(site_count)
    found = (corner >= 0) & (np.abs(power) > 0)
    samples.face[found] = corner[found] // 3
    samples.place[found, corner[found] % 3] = 1
    angle = np.angle(power) / flow.order
    samples.heading[:] = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    return samples


def follow(
    flow: Flow, samples: Samples, first: Int32[np.ndarray, "line"], *, stride: int, steps: int, quarters: int
) -> None:
    """Trace lines from samples ``first``: ``steps`` samples each, one texel apart, at ``first + stride, ...``.

    ``quarters`` right angles, counter-clockwise, lie between the field and the way: 0 and 2 follow its integral
    curves, 1 and 3 those of the orthogonal field. A line ends (its samples have face -1) at a boundary, where the
    field fades or turns too sharply within a face to tell its directions apart, and after 256 faces in one texel.
    """
    inputs = [flow.record, flow.twin, flow.order, first, stride, steps, quarters]
    launch(trace_lines, len(first), inputs=inputs, outputs=[samples.face, samples.place, samples.heading])


def _pack(
    corners: Float[np.ndarray, "face 3"],
    power: Complex[np.ndarray, "face 3"],
    texel: Float[np.ndarray, "site"],
    faces: Int32[np.ndarray, "face 3"],
    twin: Int32[np.ndarray, "face 3"],
) -> Float32[np.ndarray, "face 24"]:
    """The kernels' record of every triangle."""
    record = np.empty((len(faces), 24), np.float32)
    pairs = np.ascontiguousarray(power, np.complex64).view(np.float32).reshape(-1, 3, 2)
    inputs = [np.ascontiguousarray(corners, np.float64), pairs, np.ascontiguousarray(texel, np.float32), faces, twin]
    launch(pack_records, len(faces), inputs=inputs, outputs=[record])
    return record


def _lattice_twins(rows: int, columns: int, *, wrap: bool) -> Int32[np.ndarray, "face 3"]:
    """Twins of a lattice of cells: lower ones 2 k (left, bottom, diagonal), upper 2 k + 1 (diagonal, right, top)."""
    cell = np.arange(rows * columns).reshape(rows, columns)
    left, right = np.roll(cell, 1, axis=1), np.roll(cell, -1, axis=1)
    above, below = np.roll(cell, 1, axis=0), np.roll(cell, -1, axis=0)
    lower = np.stack([6 * left + 4, 6 * below + 5, 6 * cell + 3], axis=-1)
    upper = np.stack([6 * cell + 2, 6 * right, 6 * above + 1], axis=-1)
    if not wrap:
        lower[:, 0, 0] = lower[-1, :, 1] = -1
        upper[:, -1, 1] = upper[0, :, 2] = -1
    return np.stack([lower, upper], axis=2).reshape(-1, 3).astype(np.int32)
