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
