"""Halfedges of a triangulation in the making: walks around a point, flips, collapses and splits in place.

``tail[h]`` is the point halfedge h runs from (-1: its face is gone), ``twin[h]`` the halfedge on its other side
(-1: the rim), ``first[v]`` any halfedge from v, ``rim[v]`` whether v lies on the rim.
"""

# ruff: noqa: UP018 (in a kernel int(0) declares a variable that a loop may change, 0 a constant)

import warp as wp

from texloom.kernels.ground import after, before

MOST_AROUND = wp.constant(4096)  # halfedges from one point


@wp.func
def fan_start(twin: wp.array(dtype=int), h: int, on_rim: int) -> int:
    """The halfedge from which ``next_around`` passes all others of its tail."""
    start = int(h)
    if on_rim == 1:
        for _ in range(MOST_AROUND):
            t = twin[start]
            if t < 0:
                break
            start = after(t)
    return start


@wp.func
def next_around(twin: wp.array(dtype=int), h: int, start: int) -> int:
    """The next halfedge counter-clockwise around the tail, -1 when all were seen."""
    t = twin[before(h)]
    return wp.where(t == start, -1, t)


@wp.func
def are_joined(tail: wp.array(dtype=int), twin: wp.array(dtype=int), start: int, v: int) -> int:
    """Whether the vertex whose fan begins at ``start`` has an edge to v."""
    h = int(start)
    found = int(0)
    for _ in range(MOST_AROUND):
        if tail[after(h)] == v or tail[before(h)] == v:
            found = 1
        h = next_around(twin, h, start)
        if found == 1 or h < 0:
            break
    return found


@wp.func
def link(twin: wp.array(dtype=int), h: int, t: int) -> int:
    """Make h and t each other's twin; -1 is the rim."""
    if h >= 0:
        twin[h] = t
    if t >= 0:
        twin[t] = h
    return 0


@wp.func
def flip(tail: wp.array(dtype=int), twin: wp.array(dtype=int), first: wp.array(dtype=int), h: int) -> int:
    """Replace edge a b by c d: faces (a, b, c), (b, a, d) become (d, c, a), (c, d, b)."""
    t = twin[h]
    hn = after(h)
    hp = before(h)
    tn = after(t)
    tp = before(t)
    a = tail[h]
    b = tail[t]
    c = tail[hp]
    d = tail[tp]
    bc = twin[hn]
    ca = twin[hp]
    ad = twin[tn]
    db = twin[tp]
    tail[h] = d
    tail[hn] = c
    tail[hp] = a
    tail[t] = c
    tail[tn] = d
    tail[tp] = b
    link(twin, hn, ca)
    link(twin, hp, ad)
    link(twin, tn, db)
    link(twin, tp, bc)
    first[a] = hp
    first[b] = tp
    first[c] = hn
    first[d] = tn
    return 0


@wp.func
def may_collapse(
    tail: wp.array(dtype=int),
    twin: wp.array(dtype=int),
    first: wp.array(dtype=int),
    rim: wp.array(dtype=int),
    at: wp.array(dtype=wp.vec3d),
    h: int,
    least: wp.float64,
) -> int:
    """Whether the tail of h can go into its head: the surface stays what it was, and no face turns over.

    ``least`` is the cosine of the most a face may turn.
    """
    t = twin[h]
    a = tail[h]
    b = tail[after(h)]
    if rim[a] == 1 and rim[b] == 1 and t >= 0:
        return 0
    if rim[a] == 1 and rim[b] == 0:
        return 0
    c = tail[before(h)]
    d = int(-1)
    if t >= 0:
        d = tail[before(t)]
    ok = int(1)
    around_b = fan_start(twin, first[b], rim[b])
    start = fan_start(twin, first[a], rim[a])
    e = int(start)
    for _ in range(MOST_AROUND):
        u = tail[after(e)]
        w = tail[before(e)]
        if u != b and u != c and u != d and are_joined(tail, twin, around_b, u) == 1:
            ok = 0
        if twin[before(e)] < 0 and w != b and w != c and w != d and are_joined(tail, twin, around_b, w) == 1:
            ok = 0
        if u != b and w != b:
            old = wp.cross(at[u] - at[a], at[w] - at[a])
            new = wp.cross(at[u] - at[b], at[w] - at[b])
            if wp.dot(old, new) < least * wp.length(old) * wp.length(new):
                ok = 0
        e = next_around(twin, e, start)
        if ok == 0 or e < 0:
            break
    for k in range(2):
        v = wp.where(k == 0, c, d)
        if ok == 1 and v >= 0:
            faces = int(0)
            begin = fan_start(twin, first[v], rim[v])
            g = int(begin)
            for _ in range(4):
                faces = faces + 1
                g = next_around(twin, g, begin)
                if g < 0:
                    break
            if faces < 4 - 2 * rim[v]:
                ok = 0
    return ok


@wp.func
def close_up(tail: wp.array(dtype=int), twin: wp.array(dtype=int), first: wp.array(dtype=int), h: int, b: int) -> int:
    """Take out the face of h, whose tail became b: glue its other two sides together."""
    c = tail[before(h)]
    x = twin[before(h)]
    y = twin[after(h)]
    if x >= 0:
        twin[x] = y
        first[b] = x
        first[c] = after(x)
    if y >= 0:
        twin[y] = x
        first[c] = y
        if x < 0:
            first[b] = after(y)
    tail[h] = -1
    tail[after(h)] = -1
    tail[before(h)] = -1
    return 0


@wp.func
def collapse(
    tail: wp.array(dtype=int), twin: wp.array(dtype=int), first: wp.array(dtype=int), rim: wp.array(dtype=int), h: int
) -> int:
    """Move the tail of h into its head."""
    t = twin[h]
    a = tail[h]
    b = tail[after(h)]
    start = fan_start(twin, first[a], rim[a])
    e = int(start)
    for _ in range(MOST_AROUND):
        following = next_around(twin, e, start)
        tail[e] = b
        e = following
        if e < 0:
            break
    close_up(tail, twin, first, h, b)
    if t >= 0:
        close_up(tail, twin, first, t, b)
    first[a] = -1
    return 0


@wp.func
def split(
    tail: wp.array(dtype=int), twin: wp.array(dtype=int), first: wp.array(dtype=int), h: int, v: int, free: int
) -> int:
    """Put vertex v on edge a b: faces (a, b, c), (b, a, d) become (a, v, c), (v, b, c), (b, v, d), (v, a, d).

    The new faces' halfedges begin at ``free``; without a face on the other side there is one.
    """
    t = twin[h]
    b = tail[after(h)]
    a = tail[h]
    c = tail[before(h)]
    outer = twin[after(h)]
    tail[after(h)] = v
    tail[free] = v
    tail[free + 1] = b
    tail[free + 2] = c
    link(twin, free + 1, outer)
    link(twin, free + 2, after(h))
    first[v] = after(h)
    first[b] = free + 1
    first[a] = h
    if t < 0:
        twin[free] = -1
        return 0
    d = tail[before(t)]
    other = twin[after(t)]
    tail[after(t)] = v
    tail[free + 3] = v
    tail[free + 4] = a
    tail[free + 5] = d
    link(twin, free + 4, other)
    link(twin, free + 5, after(t))
    link(twin, h, free + 3)
    link(twin, t, free)
    return 0
