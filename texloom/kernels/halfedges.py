"""Halfedges of a triangulation in the making: walks around a point, flips, collapses and splits in place."""

# ruff: noqa: UP018 (in a kernel int(0) declares a variable that a loop may change, 0 a constant)

import warp as wp

from texloom.kernels.ground import Places, after, before

MOST_AROUND = wp.constant(4096)  # halfedges from one point


@wp.struct
class Net:
    """Which points are joined, by halfedges."""

    tail: wp.array(dtype=int)  # the point that each halfedge runs from, -1: its face is gone
    twin: wp.array(dtype=int)  # the halfedge on its other side, -1: the rim
    first: wp.array(dtype=int)  # any halfedge from each point
    rim: wp.array(dtype=int)  # 1 for points of the rim


@wp.func
def fan_start(net: Net, v: int) -> int:
    """The halfedge from v after which ``next_around`` passes all others."""
    start = int(net.first[v])
    if net.rim[v] == 1:
        for _ in range(MOST_AROUND):
            t = net.twin[start]
            if t < 0:
                break
            start = after(t)
    return start


@wp.func
def next_around(net: Net, h: int, start: int) -> int:
    """The next halfedge counter-clockwise around the tail, -1 when all were seen."""
    t = net.twin[before(h)]
    return wp.where(t == start, -1, t)


@wp.func
def are_joined(net: Net, start: int, v: int) -> int:
    """Whether the vertex whose fan begins at ``start`` has an edge to v."""
    h = int(start)
    found = int(0)
    for _ in range(MOST_AROUND):
        if net.tail[after(h)] == v or net.tail[before(h)] == v:
            found = 1
        h = next_around(net, h, start)
        if found == 1 or h < 0:
            break
    return found


@wp.func
def link(net: Net, h: int, t: int) -> int:
    """Make h and t each other's twin; -1 is the rim."""
    if h >= 0:
        net.twin[h] = t
    if t >= 0:
        net.twin[t] = h
    return 0


@wp.func
def flip(net: Net, h: int) -> int:
    """Replace edge a b by c d: faces (a, b, c), (b, a, d) become (d, c, a), (c, d, b)."""
    t = net.twin[h]
    hn = after(h)
    hp = before(h)
    tn = after(t)
    tp = before(t)
    a = net.tail[h]
    b = net.tail[t]
    c = net.tail[hp]
    d = net.tail[tp]
    bc = net.twin[hn]
    ca = net.twin[hp]
    ad = net.twin[tn]
    db = net.twin[tp]
    net.tail[h] = d
    net.tail[hn] = c
    net.tail[hp] = a
    net.tail[t] = c
    net.tail[tn] = d
    net.tail[tp] = b
    link(net, hn, ca)
    link(net, hp, ad)
    link(net, tn, db)
    link(net, tp, bc)
    net.first[a] = hp
    net.first[b] = tp
    net.first[c] = hn
    net.first[d] = tn
    return 0


@wp.func
def may_collapse(net: Net, places: Places, h: int, least: wp.float64) -> int:
    """Whether the tail of h can go into its head: the surface stays what it was, and no face turns over.

    ``least`` is the cosine of the most a face may turn.
    """
    t = net.twin[h]
    a = net.tail[h]
    b = net.tail[after(h)]
    if net.rim[a] == 1 and net.rim[b] == 1 and t >= 0:
        return 0
    if net.rim[a] == 1 and net.rim[b] == 0:
        return 0
    c = net.tail[before(h)]
    d = int(-1)
    if t >= 0:
        d = net.tail[before(t)]
    ok = int(1)
    around_b = fan_start(net, b)
    start = fan_start(net, a)
    e = int(start)
    for _ in range(MOST_AROUND):
        u = net.tail[after(e)]
        w = net.tail[before(e)]
        if u != b and u != c and u != d and are_joined(net, around_b, u) == 1:
            ok = 0
        if net.twin[before(e)] < 0 and w != b and w != c and w != d and are_joined(net, around_b, w) == 1:
            ok = 0
        if u != b and w != b:
            old = wp.cross(places.at[u] - places.at[a], places.at[w] - places.at[a])
            new = wp.cross(places.at[u] - places.at[b], places.at[w] - places.at[b])
            if wp.dot(old, new) < least * wp.length(old) * wp.length(new):
                ok = 0
        e = next_around(net, e, start)
        if ok == 0 or e < 0:
            break
    for k in range(2):
        v = wp.where(k == 0, c, d)
        if ok == 1 and v >= 0:
            faces = int(0)
            begin = fan_start(net, v)
            g = int(begin)
            for _ in range(4):
                faces = faces + 1
                g = next_around(net, g, begin)
                if g < 0:
                    break
            if faces < 4 - 2 * net.rim[v]:
                ok = 0
    return ok


@wp.func
def close_up(net: Net, h: int, b: int) -> int:
    """Take out the face of h, whose tail became b: glue its other two sides together."""
    c = net.tail[before(h)]
    x = net.twin[before(h)]
    y = net.twin[after(h)]
    if x >= 0:
        net.twin[x] = y
        net.first[b] = x
        net.first[c] = after(x)
    if y >= 0:
        net.twin[y] = x
        net.first[c] = y
        if x < 0:
            net.first[b] = after(y)
    net.tail[h] = -1
    net.tail[after(h)] = -1
    net.tail[before(h)] = -1
    return 0


@wp.func
def collapse(net: Net, h: int) -> int:
    """Move the tail of h into its head."""
    t = net.twin[h]
    a = net.tail[h]
    b = net.tail[after(h)]
    start = fan_start(net, a)
    e = int(start)
    for _ in range(MOST_AROUND):
        following = next_around(net, e, start)
        net.tail[e] = b
        e = following
        if e < 0:
            break
    close_up(net, h, b)
    if t >= 0:
        close_up(net, t, b)
    net.first[a] = -1
    return 0


@wp.func
def split(net: Net, h: int, v: int, free: int) -> int:
    """Put vertex v on edge a b: faces (a, b, c), (b, a, d) become (a, v, c), (v, b, c), (b, v, d), (v, a, d).

    The new faces' halfedges begin at ``free``; without a face on the other side there is one.
    """
    t = net.twin[h]
    b = net.tail[after(h)]
    a = net.tail[h]
    c = net.tail[before(h)]
    outer = net.twin[after(h)]
    net.tail[after(h)] = v
    net.tail[free] = v
    net.tail[free + 1] = b
    net.tail[free + 2] = c
    link(net, free + 1, outer)
    link(net, free + 2, after(h))
    net.first[v] = after(h)
    net.first[b] = free + 1
    net.first[a] = h
    if t < 0:
        net.twin[free] = -1
        return 0
    d = net.tail[before(t)]
    other = net.twin[after(t)]
    net.tail[after(t)] = v
    net.tail[free + 3] = v
    net.tail[free + 4] = a
    net.tail[free + 5] = d
    link(net, free + 4, other)
    link(net, free + 5, after(t))
    link(net, h, free + 3)
    link(net, t, free)
    return 0
