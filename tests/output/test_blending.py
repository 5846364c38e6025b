"""Blending over edges: neighbours' maps against unfolding, errors against sums, and a picture without a break."""

import numpy as np
import pytest

from tests.naive import bilinear
from tests.output.quilted import continued, thrown
from tests.output.shapes import grid_mesh, sphere
from texloom.errors import ParameterError
from texloom.exemplar.exemplar import Map
from texloom.kernels.launch import thread_count, use
from texloom.mesh.mesh import Mesh
from texloom.output.blended_atlas import face_sites
from texloom.output.blending import Viewer, blend, edge_errors, neighbours
from texloom.output.gather import gather_sites

SHAPE = (40, 56)
IMAGE = np.random.default_rng(3).random((*SHAPE, 3), dtype=np.float32)


def naive_neighbours(mesh, coordinates):
    """Per face: the similarity (a, b, row, column) that moves the two shared corners, solved as a linear system."""
    found = np.repeat(coordinates[:, None], 3, axis=1).astype(float)
    faces = [tuple(face) for face in mesh.faces]
    for f, face in enumerate(faces):
        for k in range(3):
            p, q = face[(k + 1) % 3], face[(k + 2) % 3]
            for g, other in enumerate(faces):
                if g == f or p not in other or q not in other:
                    continue
                rows, wanted = [], []
                for vertex in (p, q):
                    row, column = coordinates[f, face.index(vertex)]
                    there_row, there_column = coordinates[g, other.index(vertex)]
                    rows += [[row, column, 1, 0], [column, -row, 0, 1]]
                    wanted += [there_row, there_column]
                a, b, down, right = np.linalg.solve(rows, wanted)
                for c in range(3):
                    row, column = coordinates[f, c]
                    found[f, k, c] = a * row + b * column + down, a * column - b * row + right
    return found


@pytest.mark.parametrize("mesh", [sphere(4), grid_mesh(3)[0]], ids=["closed", "open"])
def test_a_neighbours_map_goes_on_beyond_the_edge(mesh):
    coordinates = thrown(mesh, SHAPE, texel=0.08)
    np.testing.assert_allclose(neighbours(mesh, coordinates).positions, naive_neighbours(mesh, coordinates), atol=1e-3)


def test_a_face_unfolds_beside_its_neighbour_at_its_own_size():
    mesh = sphere(5)
    laid = neighbours(mesh, thrown(mesh, SHAPE, texel=0.05)).positions
    sides = np.linalg.norm(laid - np.roll(laid, -1, axis=2), axis=3)
    corners = mesh.vertices[mesh.faces]
    true = np.linalg.norm(corners - np.roll(corners, -1, axis=1), axis=2) / 0.05
    np.testing.assert_allclose(sides, np.repeat(true[:, None], 3, axis=1), rtol=1e-4)


def test_one_map_has_no_edges_to_blend():
    mesh = grid_mesh(4)[0]
    coordinates = continued(mesh, 15.0)
    laid = neighbours(mesh, coordinates)
    np.testing.assert_allclose(laid.positions, np.repeat(coordinates[:, None], 3, axis=1), atol=1e-5)
    np.testing.assert_allclose(laid.turn, 0, atol=1e-6)
    errors = edge_errors(mesh, coordinates, IMAGE)
    assert len(errors.mean) == 3 * 16 - 8 and not errors.mean.any() and not errors.root.any()
    assert not errors.blended(threshold=0.1).any()


@pytest.mark.parametrize("met", [None, 0, 1], ids=["apart", "meeting at the tail", "meeting at the head"])
def test_the_error_is_the_mean_colour_distance_along_the_edge(met):
    mesh = sphere(4)
    coordinates = thrown(mesh, SHAPE, texel=0.07)
    if met is not None:  # every other face lies at its neighbour's corner
        for h in range(0, mesh.faces.size, 6):
            (f, i), (g, j) = divmod(h, 3), divmod(mesh.twins[h], 3)
            coordinates[f, (i + met) % 3] = coordinates[g, (j + 1 - met) % 3]
    errors = edge_errors(mesh, coordinates, IMAGE)
    assert (mesh.twins[errors.halfedge] > errors.halfedge).all() and len(errors.mean) == len(mesh.edges)
    for number in range(0, len(errors.mean), 5):
        h = errors.halfedge[number]
        (f, i), (g, j) = divmod(h, 3), divmod(mesh.twins[h], 3)
        a, b = coordinates[f, i], coordinates[f, (i + 1) % 3]
        c, d = coordinates[g, (j + 1) % 3], coordinates[g, j]
        count = int(np.ceil(max(np.linalg.norm(b - a), np.linalg.norm(d - c))))
        apart = []
        for along in (np.arange(count) + 0.5) / count:
            ours, theirs = bilinear(IMAGE, *(a + along * (b - a))), bilinear(IMAGE, *(c + along * (d - c)))
            apart.append(255 * np.linalg.norm(ours - theirs))
        np.testing.assert_allclose(errors.mean[number], np.mean(apart), rtol=1e-3)
        np.testing.assert_allclose(errors.root[number], np.sqrt(np.mean(np.square(apart))), rtol=1e-3)


def test_visibility_is_error_times_pixels():
    mesh = grid_mesh(1, 2.0)[0]  # one inner edge, 2√2 long
    coordinates = np.array([[[2, 2], [2, 6], [6, 6]], [[20, 20], [24, 24], [24, 20]]], np.float32)
    flat = np.zeros((32, 32, 1), np.float32)
    flat[16:] = 0.1
    errors = edge_errors(mesh, coordinates, flat)
    np.testing.assert_allclose(errors.mean, [25.5], rtol=1e-5)
    viewer = Viewer(width=800, field_of_view=60, distance=5)
    pixels = 800 / (np.pi / 3) * np.sqrt(8) / 5
    np.testing.assert_allclose(errors.visibility(viewer), [25.5 * pixels], rtol=1e-5)
    assert errors.blended(viewer, threshold=25.4 * pixels).all()
    assert not errors.blended(viewer, threshold=25.6 * pixels).any()
    np.testing.assert_allclose(Viewer(field_of_view=60).distance_to(mesh), np.sqrt(2) / 0.5)


def test_fewer_edges_are_blended_from_farther_away_and_above_more():
    mesh = sphere(6)
    errors = edge_errors(mesh, thrown(mesh, SHAPE, texel=0.05), IMAGE)
    levels = np.percentile(errors.visibility(Viewer(distance=10)), [20, 50, 80])
    by_threshold = [errors.blended(Viewer(distance=10), threshold=t).sum() for t in (0, *levels, 1e9)]
    by_distance = [errors.blended(Viewer(distance=d), threshold=levels[1]).sum() for d in (1, 9, 10, 11, 1000)]
    for counts in (by_threshold, by_distance):
        assert counts[0] == len(errors.mean) and counts[-1] == 0
        assert sorted(counts, reverse=True) == counts and len(set(counts)) > 3


def on_both_sides(mesh, along=(0.001, 0.2, 0.5, 0.83)):
    """Points of every inner edge as (faces, weights) in both of its faces, and their edge."""
    half = np.flatnonzero(np.arange(len(mesh.twins)) < mesh.twins)
    sides = []
    for one, flip in ((half, False), (mesh.twins[half], True)):
        faces, weights = np.repeat(one // 3, len(along)), np.zeros((len(half), len(along), 3))
        share = np.array(along)
        for row, corner in enumerate(one % 3):
            weights[row, :, corner] = share if flip else 1 - share
            weights[row, :, (corner + 1) % 3] = 1 - share if flip else share
        sides.append((faces, weights.reshape(-1, 3).astype(np.float32)))
    return sides, np.repeat(np.arange(len(half)), len(along))


def test_blended_edges_show_no_break_and_others_are_left_alone():
    mesh = sphere(5)
    coordinates = thrown(mesh, SHAPE, texel=0.06)
    errors = edge_errors(mesh, coordinates, IMAGE)
    chosen = errors.mean > np.median(errors.mean)
    made = blend(mesh, coordinates, errors.at_faces(chosen))
    assert made.count == chosen.sum()
    sides, edge = on_both_sides(mesh)
    plain = blend(mesh, coordinates)
    map = Map(IMAGE, "data", 8)
    ours, theirs = (gather_sites(made.sources(*side), map) for side in sides)
    np.testing.assert_allclose(ours[chosen[edge]], theirs[chosen[edge]], atol=2e-3)
    assert np.abs(ours - theirs)[~chosen[edge]].max() > 0.1
    bare = gather_sites(plain.sources(*sides[0]), map)
    np.testing.assert_allclose(ours[~chosen[edge]], bare[~chosen[edge]], atol=1e-5)
    assert np.abs(ours - bare)[chosen[edge]].max() > 0.1


def test_normals_meet_in_the_world_where_flat_faces_are_blended():
    mesh = grid_mesh(4)[0]
    coordinates = thrown(mesh, SHAPE, texel=0.02)
    made = blend(mesh, coordinates, np.ones(mesh.faces.shape, bool))
    frames = face_sites(mesh, coordinates)
    bumps = np.random.default_rng(8).normal([0, 0, 3], 1, (*SHAPE, 3))
    bumps /= np.linalg.norm(bumps, axis=2, keepdims=True)
    map = Map((0.5 * bumps + 0.5).astype(np.float32), "normal", 8)
    world = []
    for faces, weights in on_both_sides(mesh)[0]:
        values = 2 * gather_sites(made.sources(faces, weights), map) - 1
        axes = [vectors[3 * faces] for vectors in (frames.direction, frames.upward, frames.normal)]
        world.append(sum(values[:, [k]] * axes[k] for k in range(3)))
    np.testing.assert_allclose(world[0], world[1], atol=5e-3)
    assert np.ptp(world[0], axis=0).min() > 0.3


def test_sources_keep_the_rules_of_a_source_map():
    mesh = grid_mesh(3)[0]
    rng = np.random.default_rng(1)
    edges = rng.random(mesh.faces.shape) < 0.5
    made = blend(mesh, thrown(mesh, SHAPE, texel=0.02), edges)
    assert not made.edges[~made.neighbours.there].any() and (made.edges <= edges).all()
    corners = np.eye(3)[rng.integers(0, 3, 500)]
    inside = rng.dirichlet([1, 1, 1], 500)
    sources = made.sources(rng.integers(0, len(mesh.faces), 1000), np.concatenate([corners, inside]))
    np.testing.assert_allclose(sources.weight.sum(1), 1, atol=1e-6)
    assert (np.diff(sources.weight, axis=1) <= 0).all() and np.isfinite(sources.position).all()


def test_threads_change_nothing():
    mesh = sphere(5)
    coordinates = thrown(mesh, SHAPE, texel=0.06)
    before, found = thread_count(), []
    try:
        for threads in (1, 4):
            use(threads=threads)
            errors = edge_errors(mesh, coordinates, IMAGE)
            sides, _ = on_both_sides(mesh)
            made = blend(mesh, coordinates, errors.at_faces(errors.blended()))
            found.append((errors.mean, errors.root, *vars(made.sources(*sides[0])).values()))
    finally:
        use(threads=before)
    for one, other in zip(*found, strict=True):
        np.testing.assert_array_equal(one, other)


def test_a_face_without_area_breaks_nothing():
    mesh = Mesh(np.array([[0, 0, 0], [1, 0, 0], [1, 0, 0], [0, 1, 0.0]]), np.array([[0, 1, 2], [0, 2, 3]], np.int32))
    coordinates = np.array([[[5, 5], [5, 5], [5, 5]], [[5, 5], [5, 9], [1, 5]]], np.float32)
    errors = edge_errors(mesh, coordinates, IMAGE)
    assert np.isfinite(errors.mean).all()
    made = blend(mesh, coordinates, np.ones((2, 3), bool))
    assert np.isfinite(made.neighbours.positions).all() and not made.edges[0].any()


def test_a_viewer_who_cannot_see_is_refused():
    for wrong in ({"distance": 0.0}, {"field_of_view": 180}, {"width": 0}):
        with pytest.raises(ParameterError, match="give a distance above 0"):
            Viewer(**wrong)
