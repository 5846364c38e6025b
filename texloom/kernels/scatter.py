"""Even point sets among the sites of a domain."""

# ruff: noqa: UP018 (in a kernel int(0) declares a variable that a loop may change, 0 a constant)

import warp as wp


@wp.kernel(enable_backward=False)
def scatter_sites(
    start: int,
    turn: wp.array(dtype=int),  # sites in the order of their chance
    first: wp.array(dtype=int),  # neighbours of each site, in compressed rows
    neighbour: wp.array(dtype=int),
    position: wp.array(dtype=wp.vec3),
    period: wp.vec3,
    radius: wp.array(dtype=float),
    stamp: wp.array(dtype=int),  # -1 everywhere
    queue: wp.array(dtype=int),
    state: wp.array(dtype=int),  # 0 everywhere; 1 within reach of a chosen site, 2 chosen
):
    """Dart throwing, one thread: each site in turn is chosen unless one chosen before has it within its radius.

    A radius reaches over neighbours inside a ball only, so not through a thin sheet.
    """
    for k in range(turn.shape[0]):
        centre = turn[k]
        if state[centre] == 0:
            state[centre] = 2
            stamp[centre] = centre
            queue[0] = centre
            head = int(0)
            tail = int(1)
            while head < tail:
                s = queue[head]
                head = head + 1
                for e in range(first[s], first[s + 1]):
                    v = neighbour[e]
                    if stamp[v] != centre:
                        stamp[v] = centre
                        apart = position[v] - position[centre]
                        for c in range(3):
                            if period[c] > 0.0:
                                apart[c] = apart[c] - period[c] * wp.round(apart[c] / period[c])
                        if wp.length(apart) < radius[centre]:
                            if state[v] == 0:
                                state[v] = 1
                            queue[tail] = v
                            tail = tail + 1
