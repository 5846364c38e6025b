"""The inverse of patches: which entries fall on each site. Tables in compressed rows."""

import numpy as np
from jaxtyping import Int32

from texloom.kernels.cover import group_entries
from texloom.kernels.launch import launch


def group_by_site(
    site: Int32[np.ndarray, "entry"], site_count: int
) -> tuple[Int32[np.ndarray, "sites_plus_one"], Int32[np.ndarray, "kept"]]:
    """Where each site's entries begin, and the entries in that order; within a site they keep their order.

    Entries of site -1 are left out. A counting sort: O(entry + site) time.
    """
    starts = np.cumsum(np.bincount(site + 1, minlength=site_count + 1), dtype=np.int32)
    starts -= starts[0]  # the entries of site -1
    order = np.empty(starts[-1], np.int32)
    launch(group_entries, 1, inputs=[site], outputs=[starts[:-1].copy(), order])
    return starts, order


def ranges(start: Int32[np.ndarray, "rows_plus_one"], rows: np.ndarray) -> np.ndarray:
    """Entries of these rows of a compressed table, one row after the other."""
    length = start[rows + 1] - start[rows]
    first = np.repeat(start[rows] - (np.cumsum(length) - length), length)
    return first + np.arange(len(first))
