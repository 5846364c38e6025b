"""Integral curves against what is known of them: lines on a plane, the unrolled cone, a walk in plain NumPy."""

import numpy as np
import pytest
from numpy import ndarray

from tests.meshes import cone, flat_square, torus
from texloom.field.direction import DirectionField, from_constant, from_vectors
from texloom.field.trace import Flow, Samples, follow, planar_flow, starts, surface_flow
from texloom.kernels.launch import thread_count, use
from texloom.mesh.mesh import Mesh


def line(flow: Flow, site: int, steps: int, quarters: int = 0) -> Samples:
    """One line of samples from a site."""
    origin, samples = starts(flow), Samples.empty(steps + 1)
    for part in ("face", "place", "heading"):
        getattr(samples, part)[0] = getattr(origin, part)[site]
    follow(flow, samples, np.zeros(1, np.int32), stride=1, steps=steps, quarters=quarters)
    return samples


def points(mesh: Mesh, samples: Samples) -> ndarray:
    """Samples in space, those that were reached."""
    reached = samples.face >= 0
    return np.einsum("sc,scd->sd", samples.place[reached], mesh.vertices[mesh.faces[samples.face[reached]]])


@pytest.mark.parametrize("order", [1, 2, 4, 6])
@pytest.mark.parametrize("quarters", [0, 1, 2, 3])
def test_on_a_plane_it_is_a_straight_line(order: int, quarters: int) -> None:
    mesh = flat_square(20, 20.0)
    field = from_constant(mesh, order, np.array([np.cos(0.2), np.sin(0.2), 0]))
    flow = surface_flow(mesh, field, np.full(441, 0.7))
    found = points(mesh, line(flow, site=10 * 21 + 10, steps=12, quarters=quarters))
    way = found[1] - found[0]
    np.testing.assert_allclose(found, found[0] + np.arange(13)[:, None] * way, atol=1e-4)
    np.testing.assert_allclose(np.hypot(*way[:2]), 0.7, rtol=1e-5)
    angle = np.arctan2(way[1], way[0]) - 0.2 - quarters * np.pi / 2
    np.testing.assert_allclose(np.cos(angle * np.lcm(order, 1)), 1.0, atol=1e-4)


def test_it_ends_at_a_boundary_and_stays_ended() -> None:
    mesh = flat_square(8, 8.0)
    flow = surface_flow(mesh, from_constant(mesh, 1, np.array([1.0, 0, 0])), np.ones(81))
    samples = line(flow, site=4 * 9 + 4, steps=10)
    np.testing.assert_array_equal(samples.face[:5] >= 0, True)
    np.testing.assert_array_equal(samples.face[5:], -1)


def geodesic_field(mesh: Mesh, angle: float) -> DirectionField:
    """On a cone without its apex: the field that is constant once the cone is unrolled, from one cut on."""
    corner = mesh.vertices[mesh.faces]
    around = np.arctan2(corner[..., 1].sum(1), corner[..., 0].sum(1))  # of the face
    steepness = np.hypot(1.0, 1.0)  # radius and height are 1
    unrolled = around / steepness
    down = np.stack([np.cos(around), np.sin(around), -np.ones_like(around)], axis=1) / steepness
    # in the unrolled plane "down" points along the unrolled angle; turn from there to the constant direction
    turn = angle - unrolled
    side = np.cross(mesh.face_normals, down)
    direction = np.cos(turn)[:, None] * down + np.sin(turn)[:, None] * side
    xy = np.einsum("fad,fd->fa", mesh.face_frames, direction)
    power = (xy[:, 0] + 1j * xy[:, 1]) / np.hypot(xy[:, 0], xy[:, 1])
    return DirectionField(1, np.repeat(power[:, None], 3, axis=1).astype(np.complex64))


def test_on_a_cone_it_is_the_unrolled_straight_line() -> None:
    mesh = cone(around=96, rings=24)
    flow = surface_flow(mesh, geodesic_field(mesh, angle=np.pi / 2), np.full(len(mesh.vertices), 0.04))
    site = int(np.argmin(np.linalg.norm(mesh.vertices - [0.5, 0, 0.5], axis=1)))
    found = points(mesh, line(flow, site, steps=12))
    assert len(found) == 13
    slant = np.sqrt(2) * np.hypot(found[:, 0], found[:, 1])
    angle = np.arctan2(found[:, 1], found[:, 0]) / np.sqrt(2)
    flat = slant[:, None] * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    np.testing.assert_allclose(flat[:, 0], flat[0, 0], atol=4e-3)  # faces stand in for the smooth cone
    np.testing.assert_allclose(np.diff(flat[:, 1]), 0.04, rtol=2e-2)


def test_there_and_back_is_where_it_began() -> None:
    row, column = np.mgrid[:40, :40]
    swirl = np.exp(1j * (0.05 * row + 0.02 * column))
    flow = planar_flow(swirl, 1 + 0.01 * column, order=1, wrap=False)
    there = line(flow, site=20 * 40 + 20, steps=12)
    back = Samples.empty(13)
    back.face[0], back.place[0], back.heading[0] = there.face[-1], there.place[-1], there.heading[-1]
    follow(flow, back, np.zeros(1, np.int32), stride=1, steps=12, quarters=2)
    corners = flow.position[flow.faces]
    ends = [np.einsum("c,cd->d", s.place[-1], corners[s.face[-1]]) for s in (there, back)]
    np.testing.assert_allclose(ends[1], [20, -20, 0], atol=2e-3)
    assert np.linalg.norm(ends[0] - ends[1]) > 10


def test_a_circle_of_the_ring_field_closes_with_second_order_error() -> None:
    errors = []
    for n in (33, 129):
        row, column = np.mgrid[:n, :n] - (n - 1) / 2
        tangent = 1j * (column - 1j * row)
        tangent[np.abs(tangent) == 0] = 1
        radius = n // 3
        step = 2 * np.pi * radius / 40
        flow = planar_flow(tangent / np.abs(tangent), np.full((n, n), step), order=1, wrap=False)
        samples = line(flow, site=n // 2 * n + n // 2 + radius, steps=40)
        ends = [np.einsum("c,cd->d", samples.place[k], flow.position[flow.faces[samples.face[k]]]) for k in (0, 40)]
        errors.append(np.linalg.norm(ends[1] - ends[0]) / radius)
    assert errors[0] < 0.01
    assert errors[1] < errors[0] / 6  # a quarter of the spacing: first order would give 4


def test_a_singularity_ends_it_and_nothing_hangs() -> None:
    row, column = np.mgrid[:21, :21] - 10
    sink = -(column - 1j * row).astype(complex)
    sink[10, 10] = 1
    power = planar_flow(sink / np.maximum(np.abs(sink), 1), np.ones((21, 21)), order=1, wrap=False)
    samples = line(power, site=10 * 21 + 16, steps=50)
    assert samples.face[5] >= 0
    assert samples.face[-1] == -1


def test_a_torus_wraps_around() -> None:
    flow = planar_flow(np.ones((6, 8), complex), np.ones((6, 8)), order=1, wrap=True)
    samples = line(flow, site=2 * 8 + 3, steps=8)
    sites = flow.faces[samples.face, samples.place.argmax(axis=1)]
    np.testing.assert_array_equal(sites, 2 * 8 + (3 + np.arange(9)) % 8)


class _EndedError(Exception):
    """The walk meets a singularity."""


class _SlidesError(Exception):
    """The walk slides along an edge, which the naive one does not know."""


def naive_walk(flow: Flow, face: int, at: ndarray, heading: complex, way: complex, texels: float) -> tuple | None:
    """The kernel's walk in plain NumPy, without its fast paths; ``way`` is the turn off the field."""
    entry = -1
    for _ in range(256):
        a, b, c = flow.record[face, :3].astype(float)
        corners = np.array([0, a, b + 1j * c])
        power, texel = flow.power[face].astype(complex), flow.record[face, 9:12].astype(float)

        def rate(direction: complex, corners: ndarray = corners) -> ndarray:
            system = np.stack([corners.real, corners.imag, np.ones(3)])
            return np.linalg.solve(system, [direction.real, direction.imag, 0])

        def root(at: ndarray, heading: complex, power: ndarray = power) -> complex:
            roots = (at @ power) ** (1 / flow.order) * np.exp(2j * np.pi * np.arange(flow.order) / flow.order)
            best = roots[np.argmax((roots * np.conj(heading)).real)]
            turn = abs(np.angle(best / heading))
            if abs(at @ power) < 0.05 or turn > 0.8 or turn * flow.order > 2.2:
                raise _EndedError
            return best / abs(best)

        def leave(at: ndarray, speed: ndarray) -> tuple[float, int]:
            times = [-at[i] / speed[i] if speed[i] < 0 else np.inf for i in range(3)]
            return min(times), int(np.argmin(times))

        speed = rate(heading * way)
        when, side = leave(at, speed)
        middle = at + 0.5 * min(when, texels * (at @ texel)) * speed
        heading = root(middle, heading)
        speed = rate(heading * way)
        if entry >= 0 and speed[entry] < 0:
            raise _SlidesError
        when, side = leave(at, speed)
        length = middle @ texel
        if texels * length <= when:
            at = at + texels * length * speed
            return face, at, root(at, heading)
        texels, at = texels - when / length, at + when * speed
        edge = (side + 1) % 3
        twin = flow.twin[face, edge]
        if twin < 0:
            return None
        across, other = divmod(int(twin), 3)
        d, e, f = flow.record[across, :3].astype(float)
        theirs = np.array([0, d, e + 1j * f])
        turn = (theirs[other] - theirs[(other + 1) % 3]) / (corners[(edge + 1) % 3] - corners[edge])
        heading *= turn / abs(turn)
        place = np.zeros(3)
        place[other], place[(other + 1) % 3] = at[(edge + 1) % 3], at[edge]
        face, at, entry = across, place / place.sum(), (other + 2) % 3
    return None


@pytest.mark.parametrize("order", [1, 4])
def test_kernel_equals_the_naive_walk(order: int) -> None:
    mesh = torus(24, 12)
    swirl = np.cross(mesh.vertex_normals, [0.3, 0.2, 1.0])
    field = from_vectors(mesh, order, swirl)
    flow = surface_flow(mesh, field, np.linspace(0.2, 0.3, len(mesh.vertices)))
    rng = np.random.default_rng(5)
    count = 40
    samples = Samples.empty(2 * count)
    samples.face[:count] = rng.integers(0, len(mesh.faces), count)
    samples.place[:count] = rng.dirichlet([2, 2, 2], count)
    at_place = np.einsum("sc,sc->s", flow.power[samples.face[:count]], samples.place[:count])
    heading = at_place ** (1 / order)
    heading /= np.abs(heading)
    samples.heading[:count] = np.stack([heading.real, heading.imag], axis=1)
    follow(flow, samples, np.arange(count, dtype=np.int32), stride=count, steps=1, quarters=1)
    compared = 0
    for k in range(count):
        start = samples.place[k].astype(float)
        try:
            expected = naive_walk(flow, int(samples.face[k]), start / start.sum(), complex(heading[k]), 1j, 1.0)
        except _SlidesError:
            continue
        except _EndedError:
            assert samples.face[count + k] == -1
            continue
        assert expected is not None
        face, at, direction = expected
        assert samples.face[count + k] == face
        np.testing.assert_allclose(samples.place[count + k], at, atol=2e-4)
        np.testing.assert_allclose(samples.heading[count + k], [direction.real, direction.imag], atol=2e-4)
        compared += 1
    assert compared > 30


def test_one_thread_and_two_agree_to_the_bit() -> None:
    mesh = torus(40, 20)
    field = from_constant(mesh, 4, np.array([0.2, 0.3, 1.0]))
    flow = surface_flow(mesh, field, np.full(len(mesh.vertices), 0.05))
    before, found = thread_count(), []
    for threads in (1, 2):
        use(threads=threads)
        origin = starts(flow)
        samples = Samples(*(np.repeat(part, 9, axis=0) for part in (origin.face, origin.place, origin.heading)))
        first = np.arange(0, len(samples.face), 9, dtype=np.int32)
        follow(flow, samples, first, stride=1, steps=8, quarters=3)
        found.append(samples)
    use(threads=before)
    for part in ("face", "place", "heading"):
        np.testing.assert_array_equal(getattr(found[0], part), getattr(found[1], part))
