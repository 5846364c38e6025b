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
def turn(one: wp.vec2d, two: wp.vec2d) -> wp.float64:
    """Twice the area of a triangle, given its sides from the first corner: positive as corners are listed."""
    return one[0] * two[1] - one[1] * two[0]


@wp.func
def carry(
    carrier: wp.array(dtype=wp.vec2i), share: wp.array(dtype=wp.float64), by: wp.array(dtype=wp.vec2d), p: int
) -> wp.vec2d:
    """How far point p has moved with its carriers."""
    return (wp.float64(1.0) - share[p]) * by[carrier[p][0]] + share[p] * by[carrier[p][1]]


@wp.func
def area(sides: wp.mat22d, a: wp.vec2d, b: wp.vec2d, c: wp.vec2d) -> wp.float64:
    """Twice the area of a triangle whose corners have moved, negative where it is turned over."""
    return turn(sides[0] + b - a, sides[1] + c - a)


@wp.func
def name_carriers(
    carrier: wp.array(dtype=wp.vec2i), named: wp.array(dtype=int), queue: wp.array(dtype=int), count: int, c: wp.vec3i
) -> int:
    """Put the carriers of a triangle's corners on a list, each once; returns its length."""
    length = int(count)
    for k in range(3):
        for end in range(2):
            v = carrier[c[k]][end]
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
    carrier: wp.array(dtype=wp.vec2i),  # the vertices that carry a point
    share: wp.array(dtype=wp.float64),  # of the second
    corner: wp.array(dtype=wp.vec3i),  # points, for each triangle
    sides: wp.array(dtype=wp.mat22d),  # from its first corner to the others, where nothing has moved; again and again
    least: wp.float64,  # area that a triangle keeps, of what there was
    halvings: int,
    before: wp.array(dtype=wp.vec2d),
    step: wp.array(dtype=wp.vec2d),
    tries: wp.array(dtype=int),
    named: wp.array(dtype=int),
    queue: wp.array(dtype=int),
    carried: wp.array(dtype=wp.vec2d),  # displacement of every point
    suspects: wp.array(dtype=int),
    by: wp.array(dtype=wp.vec2d),  # displacement of every vertex
):
    """by[v] += strength * pull + noise in each iteration, halved, or left out, until no triangle is short of area.

    One thread: triangles that share a vertex wait for each other, and a launch costs more than a pass over them.
    """
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
            for p in range(carrier.shape[0]):
                carried[p] = carry(carrier, share, by, p)
            k = int(0)
            for t in range(corner.shape[0]):
                c = corner[t]
                whole = turn(sides[k][0], sides[k][1])
                left = area(sides[k], carried[c[0]], carried[c[1]], carried[c[2]])
                k = wp.where(k + 1 < sides.shape[0], k + 1, 0)
                if left < SUSPECT * whole:
                    suspects[doubtful] = t
                    doubtful = doubtful + 1
                    if left < least * whole:
                        found = name_carriers(carrier, named, queue, found, c)
            shorten(before, step, by, tries, named, queue, found, halvings)
            wrong = int(found)
            while wrong > 0:
                wrong = int(0)
                for i in range(doubtful):
                    side = sides[suspects[i] % sides.shape[0]]
                    c = corner[suspects[i]]
                    one = carry(carrier, share, by, c[0])
                    two = carry(carrier, share, by, c[1])
                    three = carry(carrier, share, by, c[2])
                    if area(side, one, two, three) < least * turn(side[0], side[1]):
                        wrong = name_carriers(carrier, named, queue, wrong, c)
                shorten(before, step, by, tries, named, queue, wrong, halvings)
