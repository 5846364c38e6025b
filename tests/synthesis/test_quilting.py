"""Triangle quilting: each patch where its neighbours go on best, inside the sample, the same on any machine."""

import numpy as np
import pytest

from tests.meshes import all_meshes, as_mesh, flat_square, octahedron, single_triangle
from tests.synthesis.quilts import X, ball, plane, sample
from tests.synthesis.samples import blobs, exemplar
from texloom.domain.faces import Faces
from texloom.errors import ParameterError
from texloom.exemplar.exemplar import from_array
from texloom.exemplar.join import join
from texloom.field.direction import from_constant
from texloom.field.smooth import smoothest
from texloom.kernels.launch import thread_count, use
from texloom.search.textons import Textons, learn_textons
from texloom.synthesis import quilting
from texloom.synthesis.quilting import Quilted, Quilting


def check_inside(textons: Textons, quilted: Quilted) -> None:
    """No corner lies outside the sample, nor is a masked texel in the box around a patch."""
    rows, columns = textons.exemplar.shape
    coordinates, patch = quilted.coordinates, quilted.faces.patch
    assert (coordinates > -1e-3).all() and (coordinates < np.array([rows - 1, columns - 1]) + 1e-3).all()
    for p in range(quilted.faces.count):
        corners = coordinates[patch == p].reshape(-1, 2)
        low, high = np.floor(corners.min(0) + 1e-3).astype(int), np.ceil(corners.max(0) - 1e-3).astype(int)
        assert textons.exemplar.usable[low[0] : high[0] + 1, low[1] : high[1] + 1].all()


def check_similar(quilted: Quilted) -> None:
    """Every patch lies in the sample as it lies in its plane, but for a place and a turn by the field's symmetry."""
    faces = quilted.faces
    there = quilted.coordinates[..., 1] + 1j * quilted.coordinates[..., 0]
    patch = faces.patch
    first = np.unique(patch, return_index=True)[1]
    ratio = (there[:, 1] - there[:, 0]) / (faces.layout[:, 1] - faces.layout[:, 0])
    np.testing.assert_allclose(ratio**faces.order, 1, atol=2e-3)
    moved = there - ratio[first][patch][:, None] * faces.layout
    np.testing.assert_allclose(moved, np.broadcast_to(moved[first][patch][:, :1], moved.shape), atol=2e-3)


@pytest.mark.parametrize("masked", [False, True], ids=["whole", "masked"])
@pytest.mark.parametrize("order", [1, 2, 4, 6])
@pytest.mark.parametrize("match", ["colours", "textons"])
def test_patches_stay_inside_the_sample_and_keep_their_shape(order, match, masked):
    textons = sample(masked=masked)
    for faces in (ball(order), ball(order, 3.0, 3, width=9.0)):
        quilted = Quilting(match=match, candidates=5).run(textons, faces, seed=3)
        check_inside(textons, quilted)
        check_similar(quilted)
        assert quilted.coordinates.dtype == np.float32 and np.isfinite(quilted.energy).all()
        assert len(quilted.energy) == 3 or quilted.stopped == "no patch moved"


@pytest.mark.parametrize("order", [1, 4])
def test_rounds_mend_what_growth_left(order):
    textons, faces = sample(), ball(order, subdivisions=3, across=7.0)
    energy = Quilting(rounds=4).run(textons, faces, seed=1).energy
    assert energy[-1] < 0.9 * energy[0] and (np.diff(energy[1:]) < 0.01 * energy[0]).all()
    assert Quilting(rounds=0).run(textons, faces, seed=1).energy == energy[:1]
    assert Quilting(rounds=1).run(textons, faces, seed=1).energy == energy[:2]


MESHES = all_meshes() | {"soup": as_mesh(np.random.default_rng(0).normal(size=(15, 3)), np.arange(15).reshape(5, 3))}


@pytest.mark.parametrize("order", [1, 6])
@pytest.mark.parametrize("name", MESHES)
def test_any_mesh_is_quilted(name, order):
    mesh = MESHES[name]
    faces = Faces.build(mesh, smoothest(mesh, order), texel=float(mesh.edge_lengths.max()) / 11)
    for growth in ("constrained", "random"):
        quilted = Quilting(order=growth).run(sample(), faces, seed=2)
        check_inside(sample(), quilted)
        check_similar(quilted)


def test_a_patch_alone_lies_at_random():
    mesh = single_triangle()
    faces = Faces.build(mesh, from_constant(mesh, 4, X), texel=0.1)
    results = [Quilting().run(sample(), faces, seed=seed) for seed in range(5)]
    assert all(result.energy == (0.0, 0.0) and result.stopped == "no patch moved" for result in results)
    assert len({tuple(result.coordinates[0, 0]) for result in results}) > 2
    for result in results:
        check_inside(sample(), result)


def test_on_a_plane_the_first_patch_goes_on_where_the_sample_does():
    textons, faces = sample(80, 80), plane(3, 8.0)
    corner = faces.mesh.vertices[faces.mesh.faces]
    at = corner[..., 0] - 1j * corner[..., 1]
    whole = 0
    for seed in range(12):
        quilted = Quilting().run(textons, faces, seed=seed)
        shift = quilted.coordinates[..., 1] + 1j * quilted.coordinates[..., 0] - at
        first = quilting._growth(faces, "constrained", seed)[0][0]
        if 0 <= shift[first].real.min() < 79 - 24 and 24 <= shift[first].imag.min() < 79:  # there is room for all
            whole += 1
            np.testing.assert_allclose(shift, np.full_like(shift, shift[first, 0]), atol=1e-2)
            assert quilted.energy[-1] < 1e-4
    assert whole >= 3


@pytest.mark.parametrize("kind", ["checker", "stripes"])
def test_what_repeats_goes_on_without_a_seam(kind):
    row, column = np.mgrid[:48, :64]
    tone = (row // 4 + column // 4) % 2 if kind == "checker" else column // 4 % 2
    textons = learn_textons(from_array((255 * tone).astype(np.uint8)), count=32, width=7, orientations=4)
    faces = plane(5, 9.0)  # of so many texels that middles lie on texels too: places need not be between them
    corner = faces.mesh.vertices[faces.mesh.faces]
    for seed in range(3):
        quilted = Quilting().run(textons, faces, seed=seed)
        across, down = quilted.coordinates[..., 1] - corner[..., 0], quilted.coordinates[..., 0] + corner[..., 1]
        assert np.ptp(across) > 1  # it does not go on in one piece
        phase = np.exp(2j * np.pi * (across + down * (kind == "checker")) / 8)
        goes_on = np.isclose(phase, np.median(phase.real) + 1j * np.median(phase.imag), atol=1e-3)
        if kind == "stripes":
            assert goes_on.all() and quilted.energy[-1] < 1e-6
        else:  # textons at the sample's border are others than those within
            assert goes_on.mean() > 0.9 and quilted.energy[-1] < 0.01


def test_several_samples_are_never_mixed():
    joined = join([exemplar(20), exemplar(26, seed=1), exemplar(18, seed=2)])
    textons = learn_textons(joined.exemplar, count=30, width=5, orientations=4)
    quilted = Quilting().run(textons, ball(4, 8.0), seed=1)
    check_inside(textons, quilted)
    shown = set()
    for corners in quilted.coordinates:
        low, high = corners.min(0), corners.max(0)
        inside = [
            k
            for k, part in enumerate(joined.parts)
            if (low > np.array([part.row, part.column]) - 1e-3).all()
            and (high < np.array([part.row + part.rows, part.column + part.columns]) - 1 + 1e-3).all()
        ]
        assert len(inside) == 1
        shown |= set(inside)
    assert len(shown) > 1


@pytest.mark.parametrize("match", ["colours", "textons"])
def test_threads_make_no_difference_and_seeds_do(match):
    faces, before, results = ball(4, 7.0), thread_count(), []
    for threads in (1, 2, 3):
        use(threads=threads)
        results.append(Quilting(match=match).run(sample(masked=True), faces, seed=1))
    use(threads=before)
    for other in results[1:]:
        np.testing.assert_array_equal(other.coordinates, results[0].coordinates)
        assert other.energy == results[0].energy
    other = Quilting(match=match).run(sample(masked=True), faces, seed=2)
    assert np.mean(other.coordinates != results[0].coordinates) > 0.9


@pytest.mark.parametrize("masked", [False, True], ids=["whole", "masked"])
def test_votes_begin_anew_where_their_numbers_end(monkeypatch, masked):
    faces = ball(4, 7.0)
    usual = Quilting().run(sample(masked=masked), faces, seed=1).coordinates
    monkeypatch.setattr(quilting, "_SEARCHES", 37)
    np.testing.assert_array_equal(Quilting().run(sample(masked=masked), faces, seed=1).coordinates, usual)


def test_votes_are_cleared_before_their_numbers_overflow():
    faces, method = ball(4, 7.0), Quilting()
    fresh, late = (quilting._Chooser(method, sample(), faces, 1) for _ in range(2))
    late._searched = quilting._SEARCHES - 50
    for chooser in (fresh, late):
        chooser.place_all(*quilting._growth(faces, "constrained", 1))
    np.testing.assert_array_equal(late.place, fresh.place)
    assert 0 < late._searched <= fresh._searched


def test_large_batches_are_placed_in_portions(monkeypatch):
    faces, told = ball(1, 7.0), []
    usual = Quilting().run(sample(), faces, seed=1).coordinates
    monkeypatch.setattr(quilting, "_AT_ONCE", 4)
    monkeypatch.setattr(quilting, "_MOST_WORK", 1)
    again = Quilting().run(sample(), faces, seed=1, report=lambda stage, done: told.append(done))
    np.testing.assert_array_equal(again.coordinates, usual)
    assert told == sorted(told) and 0 < told[0] and told[-1] == 1.0
    assert len(told) >= 2 * faces.count / 4  # one lane, and no more than four patches before something is told


def test_a_report_may_stop_the_work():
    def stop(_stage: str, done: float) -> None:
        if done > 0.4:
            raise KeyboardInterrupt

    faces = ball(1, 7.0)
    usual = Quilting().run(sample(), faces, seed=1).coordinates
    with pytest.raises(KeyboardInterrupt):
        Quilting().run(sample(), faces, seed=1, report=stop)
    np.testing.assert_array_equal(Quilting().run(sample(), faces, seed=1).coordinates, usual)


def test_split_faces_fit_where_the_whole_do_not():
    mesh = octahedron()
    field = from_constant(mesh, 2, np.array([0.3, 0.2, 1]))
    with pytest.raises(
        ParameterError, match=r"8 of 8 patches, up to \d+x\d+ texels, have no place in the sample of 36x30"
    ):
        Quilting().run(sample(), Faces.build(mesh, field, texel=0.02), seed=0)
    quilted = Quilting().run(sample(), Faces.build(mesh, field, texel=0.02, most=15.0), seed=0)
    check_inside(sample(), quilted)
    check_similar(quilted)


def long_triangle(length: float, order: int) -> Faces:
    """One face, ``length`` texels by 9, along the columns."""
    mesh = as_mesh([[0, 0, 0], [0, length, 0], [-9, length, 0]], [[0, 1, 2]])
    return Faces.build(mesh, from_constant(mesh, order, X), texel=1.0)


@pytest.mark.parametrize("match", ["colours", "textons"])
def test_a_patch_fits_if_any_of_its_turns_does(match):
    upright, level = sample(60, 12), sample(12, 60)
    for textons, order, fits in [(upright, 1, True), (level, 1, False), (level, 4, True), (level, 6, False)]:
        if fits:
            quilted = Quilting(match=match).run(textons, long_triangle(50.0, order), seed=1)
            check_inside(textons, quilted)
            check_similar(quilted)
        else:
            with pytest.raises(ParameterError, match="1 of 1 patches"):
                Quilting(match=match).run(textons, long_triangle(50.0, order), seed=1)
    strip = flat_square(6, size=36.0)
    strip = as_mesh(strip.vertices * [0.2, 1.4, 1], strip.faces)  # each face fits some turns and not others
    faces = Faces.build(strip, from_constant(strip, 4, np.array([1, 0.05, 0])), texel=0.4)
    assert np.ptp(np.array(faces.bounds), axis=0).max() > 12
    quilted = Quilting(match=match).run(level, faces, seed=1)
    check_inside(level, quilted)
    check_similar(quilted)


def test_a_patch_needs_a_whole_place():
    """From 4.2 texels left of its middle to 8.4 right, 3.2 below to 6.4 above: 15 by 12 texels at any whole place."""
    mesh = as_mesh([[0, 0, 0], [12.6, 0, 0], [0, 9.6, 0]], [[0, 1, 2]])
    faces = Faces.build(mesh, from_constant(mesh, 1, X), texel=1.0)
    for columns, rows in [(15, 12), (16, 12), (15, 30)]:
        check_inside(sample(rows, columns), Quilting().run(sample(rows, columns), faces))
    for columns, rows in [(14, 12), (15, 11), (30, 11)]:
        with pytest.raises(ParameterError, match=rf"up to 15x12 texels, .* of {columns}x{rows}: use"):
            Quilting().run(sample(rows, columns), faces)


def test_a_mask_leaves_room_or_not():
    mask = np.zeros((30, 36), bool)
    mask[4:18, 7:19] = True  # 12x14 texels
    textons = learn_textons(from_array(blobs(36)[:30], mask=mask), count=10, width=5, orientations=4)
    mesh = as_mesh([[0, 0, 0], [10, 0, 0], [0, 11, 0]], [[0, 1, 2]])
    quilted = Quilting().run(textons, Faces.build(mesh, from_constant(mesh, 1, X), texel=1.0))
    check_inside(textons, quilted)
    with pytest.raises(ParameterError, match="of 36x30 and its mask: use fewer repeats or a larger texel"):
        Quilting().run(textons, Faces.build(mesh, from_constant(mesh, 1, X), texel=0.75))


@pytest.mark.parametrize("seed", range(3))
def test_room_is_that_of_every_box(seed):
    rng = np.random.default_rng(seed)
    mask = rng.random((9, 12)) < 0.85
    tallest = quilting._tallest(mask, mask.shape, 14)
    for width in range(1, 15):
        free = [
            height
            for height in range(1, 10)
            for r in range(10 - height)
            for c in range(13 - width)
            if mask[r : r + height, c : c + width].all()
        ]
        assert tallest[width] == max(free, default=0)
    np.testing.assert_array_equal(quilting._tallest(None, (9, 12), 14), [9] * 13 + [0, 0])


@pytest.mark.parametrize(
    "wrong, message",
    [
        ({"candidates": 0}, "0 candidates"),
        ({"rounds": -1}, "-1 rounds"),
        ({"share": 0.0}, "a share of 0"),
        ({"share": 1.5}, "a share of 1.5"),
        ({"share": float("nan")}, "a share of nan"),
    ],
)
def test_parameters_are_checked(wrong, message):
    with pytest.raises(ParameterError, match=message):
        Quilting(**wrong)


def test_small_batches_in_a_row_go_together_on_one_lane():
    before = thread_count()
    use(threads=3)
    try:
        chooser = quilting._Chooser(Quilting(), sample(), ball(1), 0)
        chooser._few = 4
        assert list(chooser._runs([0, 3, 10, 18, 40, 41])) == [(0, 10, 1), (10, 18, 2), (18, 40, 3), (40, 41, 1)]
        chooser._few = 100
        assert list(chooser._runs([0, 3, 10, 40])) == [(0, 40, 1)]
    finally:
        use(threads=before)
