"""The layout of groups of faces: one place for every node, edges as near as can be to those of the single faces.

Arrays are those of ``texloom.kernels.groups``.
"""

# ruff: noqa: UP018 - int(0) and float(0.0) are how Warp declares variables that change

import warp as wp

from texloom.kernels.groups import conj_times, similar_part, stretch_of, times


@wp.func
def symmetry(branch: int, order: int):
    """The turn by ``branch`` n-ths of a circle, exact where it is a quarter."""
    quarters = 4 * branch
    if quarters % order == 0:
        q = ((quarters / order) % 4 + 4) % 4
        turn = wp.vec2d(wp.float64(1.0), wp.float64(0.0))
        if q == 1:
            turn = wp.vec2d(wp.float64(0.0), wp.float64(1.0))
        if q == 2:
            turn = wp.vec2d(wp.float64(-1.0), wp.float64(0.0))
        if q == 3:
            turn = wp.vec2d(wp.float64(0.0), wp.float64(-1.0))
        return turn
    angle = wp.float64(6.283185307179586) * wp.float64(branch) / wp.float64(order)
    return wp.vec2d(wp.cos(angle), wp.sin(angle))


@wp.func
def spread_edges(
    f: int,
    weight: wp.array(dtype=wp.float64),
    node: wp.array(dtype=int),
    value: wp.array(dtype=wp.vec2d),
    total: wp.array(dtype=wp.vec2d),
):
    """Add a face's part of the Laplacian of ``value``."""
    for e in range(3):
        i = node[3 * f + e]
        j = node[3 * f + (e + 1) % 3]
        pull = weight[3 * f + e] * (value[i] - value[j])
        total[i] = total[i] + pull
        total[j] = total[j] - pull


@wp.func
def pull_edges(
    f: int,
    turn: wp.vec2d,
    flat: wp.array(dtype=wp.vec2d),
    node: wp.array(dtype=int),
    place: wp.array(dtype=wp.vec2d),
    weight: wp.array(dtype=wp.float64),
    diagonal: wp.array(dtype=wp.float64),
    residual: wp.array(dtype=wp.vec2d),
):
    """Add the pull of a face's edges, each weighed by the cotangent across: bounded, so that thin faces do not rule."""
    for e in range(3):
        tail = flat[3 * f + e]
        head = flat[3 * f + (e + 1) % 3]
        apex = flat[3 * f + (e + 2) % 3]
        across = conj_times(tail - apex, head - apex)
        w = across[0] / wp.max(wp.abs(across[1]), wp.float64(1.0e-30))
        w = wp.clamp(w, wp.float64(0.1), wp.float64(10.0))
        weight[3 * f + e] = w
        i = node[3 * f + e]
        j = node[3 * f + (e + 1) % 3]
        diagonal[i] = diagonal[i] + w
        diagonal[j] = diagonal[j] + w
        pull = w * (place[j] - place[i] - times(turn, head - tail))
        residual[i] = residual[i] + pull
        residual[j] = residual[j] - pull


@wp.kernel(enable_backward=False)
def relax_groups(
    start: int,
    groups: wp.array(dtype=int),
    begin: wp.array(dtype=int),  # faces of each group, in compressed rows
    face: wp.array(dtype=int),
    flat: wp.array(dtype=wp.vec2d),
    order: int,
    branch: wp.array(dtype=int),
    node: wp.array(dtype=int),
    rounds: int,
    most: wp.float64,  # stretch of a face that ends the rounds
    steps: int,  # of conjugate gradients a round, at most
    tolerance: wp.float64,  # of the residual, in texels
    weight: wp.array(dtype=wp.float64),  # scratch, of each halfedge; then of each node
    diagonal: wp.array(dtype=wp.float64),
    residual: wp.array(dtype=wp.vec2d),
    ahead: wp.array(dtype=wp.vec2d),
    pulled: wp.array(dtype=wp.vec2d),
    place: wp.array(dtype=wp.vec2d),
    worst: wp.array(dtype=wp.float64),  # stretch of any face of each group
):
    """place = argmin over x of the sum over edges ij of faces f of w_ij |x_j - x_i - turn_f (flat_j - flat_i)|^2.

    ``turn`` is the face's symmetry of the field: edges follow it. Where that stretches a face too much, the next round
    takes the turn the face got, so that lengths count rather than the field (Liu et al. 2008, section 3.3).
    """
    own = groups[start + wp.tid()]
    first = begin[own]
    last = begin[own + 1]
    zero = wp.vec2d(wp.float64(0.0), wp.float64(0.0))
    for round in range(rounds):
        for k in range(first, last):
            for c in range(3):
                i = 3 * face[k] + c
                if node[i] == i:
                    diagonal[i] = wp.float64(0.0)
                    residual[i] = zero
        for k in range(first, last):
            f = face[k]
            turn = symmetry(branch[f], order)
            if round > 0:
                alpha, beta = similar_part(flat, f, place[node[3 * f]], place[node[3 * f + 1]], place[node[3 * f + 2]])
                turn = wp.normalize(alpha)
            pull_edges(f, turn, flat, node, place, weight, diagonal, residual)

        size = wp.float64(0.0)
        for k in range(first, last):
            for c in range(3):
                i = 3 * face[k] + c
                if node[i] == i:
                    ahead[i] = residual[i] / diagonal[i]
                    size += wp.dot(residual[i], ahead[i])
        for _ in range(steps):
            if size <= tolerance * tolerance:
                break
            for k in range(first, last):
                for c in range(3):
                    i = 3 * face[k] + c
                    if node[i] == i:
                        pulled[i] = zero
            for k in range(first, last):
                spread_edges(face[k], weight, node, ahead, pulled)
            along = wp.float64(0.0)
            for k in range(first, last):
                for c in range(3):
                    i = 3 * face[k] + c
                    if node[i] == i:
                        along += wp.dot(ahead[i], pulled[i])
            step = size / along
            less = wp.float64(0.0)
            for k in range(first, last):
                for c in range(3):
                    i = 3 * face[k] + c
                    if node[i] == i:
                        place[i] = place[i] + step * ahead[i]
                        residual[i] = residual[i] - step * pulled[i]
                        less += wp.dot(residual[i], residual[i]) / diagonal[i]
            share = less / size
            size = wp.float64(less)
            for k in range(first, last):
                for c in range(3):
                    i = 3 * face[k] + c
                    if node[i] == i:
                        ahead[i] = residual[i] / diagonal[i] + share * ahead[i]

        stretch = wp.float64(1.0)
        for k in range(first, last):
            f = face[k]
            alpha, beta = similar_part(flat, f, place[node[3 * f]], place[node[3 * f + 1]], place[node[3 * f + 2]])
            stretch = wp.max(stretch, stretch_of(alpha, beta))
        worst[own] = stretch
        if stretch <= most:
            break
