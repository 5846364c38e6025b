"""Samples around a site, a texel apart along the field and its orthogonal: rows off a spine, read as means of sites."""

import warp as wp

from texloom.kernels.trace import CPU_FLAGS, right_angles, walk

wp.set_module_options({"cpu_compiler_flags": CPU_FLAGS})


@wp.func
def put(
    face: int,
    place: wp.vec3,
    corners: wp.array2d(dtype=int),
    i: int,
    j: int,
    sites: wp.array3d(dtype=int),
    weights: wp.array3d(dtype=float),
):
    """Sample j of stencil i: the corners of the face it lies in, or none."""
    for c in range(3):
        if face >= 0:
            sites[i, j, c] = corners[face, c]
            weights[i, j, c] = place[c]
        else:
            sites[i, j, c] = -1
            weights[i, j, c] = 0.0


@wp.kernel(enable_backward=False)
def trace_stencils(
    start: int,
    record: wp.array2d(dtype=float),
    twin: wp.array2d(dtype=int),
    corners: wp.array2d(dtype=int),
    order: int,
    width: int,
    face: wp.array(dtype=int),  # where each stencil begins
    place: wp.array(dtype=wp.vec3),
    heading: wp.array(dtype=wp.vec2),
    sites: wp.array3d(dtype=int),
    weights: wp.array3d(dtype=float),
):
    """Stencil i: up and down from its middle and, from every sample met, left and right."""
    i = start + wp.tid()
    before = width // 2
    for down in range(2):
        f = int(face[i])
        at = wp.vec3(place[i])
        way = wp.vec2(heading[i])
        for r in range(before + 1):
            row = wp.where(down == 1, before + r, before - r)
            if r > 0 and f >= 0:
                f, at, way = walk(record, twin, order, f, at, way, right_angles(wp.where(down == 1, 3, 1)), 1.0)
            if r > 0 or down == 0:
                put(f, at, corners, i, row * width + before, sites, weights)
                for right in range(2):
                    g = int(f)
                    there = wp.vec3(at)
                    along = wp.vec2(way)
                    for c in range(1, before + 1):
                        if g >= 0:
                            g, there, along = walk(
                                record, twin, order, g, there, along, right_angles(wp.where(right == 1, 0, 2)), 1.0
                            )
                        column = wp.where(right == 1, before + c, before - c)
                        put(g, there, corners, i, row * width + column, sites, weights)
