"""Dropping charts onto a skyline, one after the other."""

import warp as wp


@wp.kernel(enable_backward=False)
def drop_charts(
    start: int,
    order: wp.array(dtype=int),
    first: wp.array(dtype=int),  # where each chart's columns begin; one more at the end
    bottom: wp.array(dtype=int),
    top: wp.array(dtype=int),
    skyline: wp.array(dtype=int),
    place: wp.array2d(dtype=int),
):
    """place[c] = (column, row) at which chart c comes to lie lowest, leftmost among equals; the skyline follows.

    rest(x) = max over columns i of skyline[x + i] - bottom[i], at least 0. A single item: charts depend on each other.
    """
    for n in range(order.shape[0]):
        chart = order[n]
        begin = first[chart]
        columns = first[chart + 1] - begin
        lowest = int(2147483647)
        at = int(0)
        for x in range(skyline.shape[0] - columns + 1):
            rest = int(0)
            for i in range(columns):
                rest = wp.max(rest, skyline[x + i] - bottom[begin + i])
                if rest >= lowest:
                    break
            if rest < lowest:
                lowest = rest
                at = x
        place[chart, 0] = at
        place[chart, 1] = lowest
        for i in range(columns):
            skyline[at + i] = lowest + top[begin + i]
