"""No read or write of triangle quilting leaves its arrays: many small cases, some as tight as can be."""

from typing import Any

import numpy as np
import pytest
from numpy import ndarray

from tests.meshes import cone, flat_square, octahedron, slivers, sphere, tetrahedron, torus
from tests.synthesis.quilted_slowly import Slow
from tests.synthesis.samples import blobs
from texloom.domain.faces import Faces
from texloom.exemplar.exemplar import from_array
from texloom.field.direction import ORDERS
from texloom.field.smooth import smoothest
from texloom.kernels.launch import Repeated
from texloom.mesh.mesh import Mesh
from texloom.search.textons import Textons, learn_textons
from texloom.synthesis import quilting
from texloom.synthesis.quilting import Quilting

GUARD = 700  # elements around every array
MESHES = [tetrahedron(), octahedron(), sphere(1), sphere(2), torus(9, 6), flat_square(4), cone(8, 3), slivers(3, 0.05)]


class Guarded:
    """A kernel that works on copies, each between elements that would show in the result or be found changed."""

    def __init__(self, kernel: Any, varying: int, *, inputs: list, outputs: list) -> None:
        self.pairs: list[tuple[ndarray, ndarray]] = []
        self.outputs = len(outputs)
        guarded = [self.surround(value) if isinstance(value, np.ndarray) else value for value in (*inputs, *outputs)]
        self.repeated = Repeated(kernel, varying, inputs=guarded[: len(inputs)], outputs=guarded[len(inputs) :])

    def surround(self, array: ndarray) -> ndarray:
        """A place for the array between NaN or -1."""
        whole = np.full(array.size + 2 * GUARD, np.nan if array.dtype.kind == "f" else -1).astype(array.dtype)
        self.pairs.append((array, whole))
        return whole[GUARD : GUARD + array.size].reshape(array.shape)

    def run(self, count: int, *numbers: int) -> None:
        for array, whole in self.pairs:
            whole[GUARD : GUARD + array.size] = array.reshape(-1)
        self.repeated.run(count, *numbers)
        for number, (array, whole) in enumerate(self.pairs):
            inner = whole[GUARD : GUARD + array.size].reshape(array.shape)
            if number < len(self.pairs) - self.outputs:
                np.testing.assert_array_equal(inner, array)  # no input is written
            array[...] = inner
            ends = np.concatenate([whole[:GUARD], whole[GUARD + array.size :]])
            assert (np.isnan(ends) if array.dtype.kind == "f" else ends == np.array(-1).astype(array.dtype)).all()


def case(seed: int) -> tuple[Quilting, Textons, Faces]:
    """Any mesh, field, sample and method; every other time the largest patch only just has a place."""
    rng = np.random.default_rng(seed)
    mesh = MESHES[rng.integers(len(MESHES))]
    mesh = Mesh(mesh.vertices * rng.normal(1, 0.1, mesh.vertices.shape), mesh.faces)
    field = smoothest(mesh, int(rng.choice(ORDERS)))
    rows, columns = (int(side) for side in rng.integers(8 if seed % 4 else 14, 30, 2))
    mask = None
    if seed % 3 == 0:
        mask = np.ones((rows, columns), bool)
        mask[rng.integers(0, rows, 2), [0, -1]] = False
    longest = float(mesh.edge_lengths.max())
    faces = Faces.build(mesh, field, texel=longest / rng.uniform(2, 7))
    if seed % 2 and mask is None:
        side = (faces.bounds[1] - faces.bounds[0]).max(-1).min(-1).max()  # by the turns by which patches are least
        faces = Faces.build(mesh, field, texel=faces.texel * float(side) / (min(rows, columns) - 3.01))
    elif seed % 4 == 0:
        faces = Faces.build(mesh, field, texel=faces.texel, width=6.0)
    method = Quilting(
        match=str(rng.choice(["colours", "textons"])),
        order=str(rng.choice(["constrained", "random"])),
        candidates=int(rng.choice([1, 3, 32, 5000])),
        rounds=2,
        share=float(rng.choice([0.3, 1.0])),
    )
    sample = from_array(blobs(30, channels=int(rng.choice([1, 3])), seed=seed)[:rows, :columns], mask=mask)
    return (
        method,
        learn_textons(sample, count=int(rng.choice([1, 9])), width=3, orientations=int(rng.choice([1, 5]))),
        faces,
    )


@pytest.mark.parametrize("part", range(4))
def test_arrays_are_never_left(part, monkeypatch):
    run = 0
    for seed in range(part, 40, 4):
        method, textons, faces = case(seed)
        plain = method.run(textons, faces, seed=seed)
        with monkeypatch.context() as patched:
            patched.setattr(quilting, "Repeated", Guarded)
            guarded = method.run(textons, faces, seed=seed)
        np.testing.assert_array_equal(guarded.coordinates, plain.coordinates)
        assert guarded.energy == plain.energy and np.isfinite(plain.energy).all()
        rows, columns = textons.exemplar.shape
        assert (plain.coordinates > -1e-3).all()
        assert (plain.coordinates < np.array([rows - 1, columns - 1]) + 1e-3).all()
        assert max(plain.energy) < 1e3  # no point of any string shows a masked texel
        run += 1
    assert run == 10


def test_points_of_strings_stay_inside_the_sample_at_every_place():
    """A string's offsets, added to any whole place with room, are texels of the sample, in its own row."""
    for seed in range(0, 40, 4):
        _, textons, faces = case(seed)
        slow, rows, columns = Slow(textons, faces), *textons.exemplar.shape
        nowhere = np.zeros(faces.count, complex), np.zeros(faces.count, int)
        for p in range(min(faces.count, 12)):
            for b in range(faces.order):
                string, room = slow.string(p, b, *nowhere), np.argwhere(slow.room(p, b))
                if len(room) and len(string):
                    assert (room.min(0) + [string.row.min(), string.column.min()] >= 0).all()
                    assert (room.max(0) + [string.row.max(), string.column.max()] < [rows, columns]).all()


def test_long_strings_are_thinned(monkeypatch):
    """With more points than votes can count, every second or third votes."""
    mesh = flat_square(1, size=1.0)
    mesh = Mesh(mesh.vertices * [2300.0, 5.0, 1.0], mesh.faces)
    faces = Faces.build(mesh, smoothest(mesh, 1), texel=1.0)
    colours = np.zeros((12, 2400, 1), np.uint8)
    colours[:, ::7] = 200
    textons = learn_textons(from_array(colours), count=8, width=3, orientations=1)
    longest = int(faces.border_length.max())
    assert longest > quilting._MOST_VOTES
    for match in ("textons", "colours"):
        quilted = Quilting(match=match, rounds=0).run(textons, faces, seed=1)
        assert quilted.energy[0] < 0.05
        first = quilted.coordinates[:, :, 1]
        assert (first > -1e-3).all() and (first < 2399 + 1e-3).all()
