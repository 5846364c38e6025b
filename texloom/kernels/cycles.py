"""The cycles of a permutation, such as the walks around the faces of a graph."""

# ruff: noqa: UP018 (in a kernel int(0) declares a variable that a loop may change, 0 a constant)

import warp as wp


@wp.kernel(enable_backward=False)
def list_cycles(
    start: int,
    following: wp.array(dtype=int),
    seen: wp.array(dtype=int),  # 0 to begin with
    opens: wp.array(dtype=int),  # 0 to begin with
    member: wp.array(dtype=int),
):
    """member = cycle after cycle, each from its lowest member, in the order of those; opens[n] = 1 where one begins.

    One thread: a step takes two nanoseconds, and each waits for the one before.
    """
    n = int(0)
    for first in range(following.shape[0]):
        if seen[first] == 0:
            opens[n] = 1
            at = int(first)
            while seen[at] == 0:
                seen[at] = 1
                member[n] = at
                n = n + 1
                at = following[at]
