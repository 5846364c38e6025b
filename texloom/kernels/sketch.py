"""Vertices of a texture mesh drawn towards a sketch's, by no more than keeps its triangles from turning over."""

# ruff: noqa: UP018 (in a kernel int(0) declares a variable that a loop may change, 0 a constant)

import warp as wp

SUSPECT = wp.constant(wp.float64(0.5))  # of its area: a triangle left with less is looked at again and again
HALF = wp.constant(wp.float64(0.5))
NEAREST = wp.constant(wp.float64(1.0e-6))  # texels: from there on a vertex is at its joint


@wp.func
def pull(
    p: wp.vec2d,
    size: wp.vec2d,
    cells: wp.vec2i,
    first: int,
    disc: wp.array(dtype=wp.vec2d),
    middle: wp.array(dtype=wp.vec2d),
    joint: wp.array(dtype=wp.vec2d),
    disc_radius: wp.float64,
    radius: wp.float64,
) -> wp.vec2d:
    """Σ (q - p)/|q - p| / Σ 1/|q - p| over the joints q within a radius of p, of the disc that p lies in; else 0."""
    pitch = wp.cw_div(size, wp.vec2d(wp.float64(cells[0]), wp.float64(cells[1])))
    at = p - wp.vec2d(wp.floor(p[0] / size[0]) * size[0], wp.floor(p[1] / size[1]) * size[1])
    i = wp.min(int(at[0] / pitch[0]), cells[0] - 1)
    j = wp.min(int(at[1] / pitch[1]), cells[1] - 1)
    cell = first + i * cells[1] + j
    corner = wp.vec2d(wp.float64(i) * pitch[0], wp.float64(j) * pitch[1])
    from_middle = at - corner - disc[cell]
    total = wp.vec2d(wp.float64(0.0), wp.float64(0.0))
    weight = wp.float64(0.0)
    if wp.length(from_middle) <= disc_radius:
        in_sketch = middle[cell] + from_middle
        # The first joint in reach
        low = int(0)
        high = int(joint.shape[0])
        while low < high:
            half = (low + high) // 2
            if joint[half][0] < in_sketch[0] - radius:
                low = half + 1
            else:
                high = half
        k = int(low)
        while k < joint.shape[0]:
            q = joint[k]
            if q[0] > in_sketch[0] + radius:
                break
            distance = wp.length(q - in_sketch)
            if distance <= radius and wp.length(q - middle[cell]) <= disc_radius:
                distance = wp.max(distance, NEAREST)
                total = total + (q - in_sketch) / distance
                weight = weight + wp.float64(1.0) / distance
            k = k + 1
    return total / wp.max(weight, wp.float64(1.0e-300))


@wp.func
def turn(a: wp.vec2d, b: wp.vec2d, c: wp.vec2d) -> wp.float64:
    """Twice the area of a triangle, positive as corners are listed."""
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])


@wp.func
def carried(
    corner: wp.array(dtype=wp.vec2d),
    carrier: wp.array(dtype=wp.vec2i),
    share: wp.array(dtype=wp.float64),
    by: wp.array(dtype=wp.vec2d),
    k: int,
) -> wp.vec2d:
    """Where corner k is when its carriers have moved."""
    return corner[k] + (wp.float64(1.0) - share[k]) * by[carrier[k][0]] + share[k] * by[carrier[k][1]]


@wp.func
def area_left(
    corner: wp.array(dtype=wp.vec2d),
    carrier: wp.array(dtype=wp.vec2i),
    share: wp.array(dtype=wp.float64),
    by: wp.array(dtype=wp.vec2d),
    t: int,
) -> wp.float64:
    """What is left of a triangle's area when its carriers have moved, of what there was."""
    a = carried(corner, carrier, share, by, 3 * t)
    b = carried(corner, carrier, share, by, 3 * t + 1)
    c = carried(corner, carrier, share, by, 3 * t + 2)
    return turn(a, b, c) / turn(corner[3 * t], corner[3 * t + 1], corner[3 * t + 2])


@wp.func
def name_carriers(
    carrier: wp.array(dtype=wp.vec2i), named: wp.array(dtype=int), queue: wp.array(dtype=int), count: int, t: int
) -> int:
    """Put a triangle's carriers on a list, each once; returns its length."""
    length = int(count)
    for k in range(3 * t, 3 * t + 3):
        for end in range(2):
            v = carrier[k][end]
            if named[v] == 0:
                named[v] = 1
                queue[length] = v
                length = length + 1
    return length


@wp.func
def shorten(
    before: wp.array(dtype=wp.vec2d),
    step: wp.array(dtype=wp.vec2d),
    by: wp.array(dtype=wp.vec2d),
    tries: wp.array(dtype=int),
    named: wp.array(dtype=int),
    queue: wp.array(dtype=int),
    count: int,
    halvings: int,
):
    """Halve the steps of the vertices on a list, and leave those out that have been halved too often."""
    for i in range(count):
        v = queue[i]
        named[v] = 0
        tries[v] = tries[v] + 1
        step[v] = wp.where(tries[v] > halvings, wp.float64(0.0), HALF) * step[v]
        by[v] = before[v] + step[v]


@wp.kernel(enable_backward=False)
def refine(
    start: int,
    iterations: int,
    place: wp.array(dtype=wp.vec2d),  # of all vertices, where nothing has moved
    loose: wp.array(dtype=int),  # the vertices that may move
    size: wp.vec2d,  # of the torus
    cells: wp.vec2i,  # of a lattice over it, one disc in each
    origin: wp.array(dtype=wp.vec2d),  # of the lattice, for each iteration
    disc: wp.array(dtype=wp.vec2d),  # iteration by iteration: the discs' middles, from their cells' corners
    middle: wp.array(dtype=wp.vec2d),  # the same in the sketch
    joint: wp.array(dtype=wp.vec2d),  # the sketch's vertices, by row, in texels of the texture
    disc_radius: wp.float64,
    radius: wp.float64,
    strength: wp.float64,
    noise: wp.array(dtype=wp.vec2d),  # iteration by iteration, for each loose vertex
    corner: wp.array(dtype=wp.vec2d),  # three for each triangle
    carrier: wp.array(dtype=wp.vec2i),  # the vertices that carry a corner
    share: wp.array(dtype=wp.float64),  # of the second
    least: wp.float64,  # area that a triangle keeps, of what there was
    halvings: int,
    before: wp.array(dtype=wp.vec2d),
    step: wp.array(dtype=wp.vec2d),
    tries: wp.array(dtype=int),
    named: wp.array(dtype=int),
    queue: wp.array(dtype=int),
    suspects: wp.array(dtype=int),
    by: wp.array(dtype=wp.vec2d),  # displacement of every vertex
):
    """by[v] += strength * pull + noise in each iteration, halved, or left out, until no triangle is short of area.

    One thread: triangles that share a vertex wait for each other, and a launch costs more than a pass over them.
    """
    triangles = corner.shape[0] // 3
    for iteration in range(iterations):
        for i in range(loose.shape[0]):
            v = loose[i]
            at = place[v] + by[v] - origin[iteration]
            first = iteration * cells[0] * cells[1]
            drawn = pull(at, size, cells, first, disc, middle, joint, disc_radius, radius)
            step[v] = strength * drawn + noise[iteration * loose.shape[0] + i]
            tries[v] = 0
            before[v] = by[v]
        for i in range(loose.shape[0]):
            by[loose[i]] = before[loose[i]] + step[loose[i]]

        # All triangles, then those in doubt until they are right, then all again
        found = int(1)
        while found > 0:
            found = int(0)
            doubtful = int(0)
            for t in range(triangles):
                left = area_left(corner, carrier, share, by, t)
                if left < SUSPECT:
                    suspects[doubtful] = t
                    doubtful = doubtful + 1
                    if left < least:
                        found = name_carriers(carrier, named, queue, found, t)
            shorten(before, step, by, tries, named, queue, found, halvings)
            wrong = int(found)
            while wrong > 0:
                wrong = int(0)
                for i in range(doubtful):
                    if area_left(corner, carrier, share, by, suspects[i]) < least:
                        wrong = name_carriers(carrier, named, queue, wrong, suspects[i])
                shorten(before, step, by, tries, named, queue, wrong, halvings)
