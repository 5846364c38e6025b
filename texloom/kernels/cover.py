"""Turning patches inside out: from the sites of every sample to the samples on every site."""

import warp as wp


@wp.kernel(enable_backward=False)
def group_entries(start: int, site: wp.array(dtype=int), free: wp.array(dtype=int), order: wp.array(dtype=int)):
    """The last pass of a counting sort, one thread: entries by site, in increasing order within a site.

    ``free[s]`` is the next free place of site s and is used up; entries of site -1 are left out.
    """
    for e in range(site.shape[0]):
        s = site[e]
        if s >= 0:
            at = free[s]
            order[at] = e
            free[s] = at + 1


@wp.kernel(enable_backward=False)
def colour_greedily(
    start: int,
    ring_start: wp.array(dtype=int),
    ring: wp.array(dtype=int),  # neighbours of each site, in compressed rows
    colour: wp.array(dtype=int),
):
    """Every site takes the lowest of 64 colours that no neighbour before it took; beyond, the last. One item."""
    for site in range(colour.shape[0]):
        taken = wp.uint64(0)
        for e in range(ring_start[site], ring_start[site + 1]):
            if ring[e] < site:
                taken = taken | (wp.uint64(1) << wp.uint64(colour[ring[e]]))
        free = int(0)
        while free < 63 and (taken >> wp.uint64(free)) % wp.uint64(2) == wp.uint64(1):
            free += 1
        colour[site] = free
