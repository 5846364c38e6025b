"""The k most alike texels of each texel: the candidates of k-coherence search (Tong et al. 2002, section 4)."""

import numpy as np
from jaxtyping import Bool, Float32, Int32, Int64

from texloom.arrays import Image
from texloom.errors import ParameterError
from texloom.exemplar.appearance import fill_masked, neighborhood_vectors
from texloom.exemplar.blas import over_blocks

_STRIDE = 2  # of the texels that are searched for; those between take over what their neighbours found
_POOL = 4  # times k: nearest texels looked at, since most are next to each other
_EPSILON = 1.0  # of the tree: a found texel may be twice as far as the nearest; the exact costs sort it out after
_BLOCK = 4096  # texels whose candidates are chosen at once


def most_alike(
    image: Image,
    count: int,
    *,
    apart: int = 3,
    width: int = 7,
    dimensions: int = 6,
    usable: Bool[np.ndarray, "row column"] | None = None,
) -> Int32[np.ndarray, "row column k 2"]:
    """[row, column] of the ``count`` texels whose surroundings are most like each texel's, the most alike first.

    Surroundings are ``dimensions`` principal components of the Gaussian-weighted ``width × width`` neighbourhood. The
    texels are ``apart`` or more rows or columns away from the texel and from each other. Where fewer are found the
    last is repeated; where none is, the texel stands for itself.

    Departure: a tree is asked at every other texel of every other row only, approximately; every texel then chooses by
    exact cost among the shifted finds of the four around it. Structure is coherent, so little is missed.
    """
    if count < 1 or apart < 1:
        raise ParameterError(f"most alike texels: count {count} and apart {apart} must be 1 or more")
    vectors = neighborhood_vectors(fill_masked(image, usable), width=width, dimensions=dimensions)
    rows, columns = image.shape[:2]
    found = _ask_tree(vectors, count, apart, usable)
    alike = np.empty((rows * columns, count), np.int64)

    def choose(first: int, last: int) -> None:
        texel = np.arange(first, last)
        candidates = _shifted_finds(texel, found, (rows, columns), usable)
        alike[first:last] = _cheapest_apart(texel, candidates, vectors, count, apart)

    over_blocks(choose, rows * columns, _BLOCK)
    return np.stack(np.divmod(alike, columns), axis=-1).astype(np.int32).reshape(rows, columns, count, 2)


def _ask_tree(
    vectors: Float32[np.ndarray, "row column component"],
    count: int,
    apart: int,
    usable: Bool[np.ndarray, "row column"] | None,
) -> Int64[np.ndarray, "lattice_row lattice_column k"]:
    """Alike texels, as row-major numbers, of every other texel of every other row."""
    from scipy.spatial import KDTree

    rows, columns = vectors.shape[:2]
    flat = vectors.reshape(rows * columns, -1)
    member = np.arange(rows * columns) if usable is None else np.flatnonzero(usable)
    tree = KDTree(flat[member], balanced_tree=False, compact_nodes=False)
    asked = np.arange(rows * columns).reshape(rows, columns)[::_STRIDE, ::_STRIDE]
    found = np.empty((asked.size, count), np.int64)

    def ask(first: int, last: int) -> None:
        texel = asked.ravel()[first:last]
        pool = tree.query(flat[texel], k=min(1 + _POOL * count, len(member)), eps=_EPSILON)[1]
        candidates = member[pool.reshape(len(texel), -1)]
        found[first:last] = _cheapest_apart(texel, candidates, vectors, count, apart)

    over_blocks(ask, asked.size, _BLOCK // 4)
    return found.reshape(*asked.shape, count)


def _shifted_finds(
    texel: Int64[np.ndarray, "texel"],
    found: Int64[np.ndarray, "lattice_row lattice_column k"],
    shape: tuple[int, int],
    usable: Bool[np.ndarray, "row column"] | None,
) -> Int64[np.ndarray, "texel candidate"]:
    """What the four asked texels around each texel found, moved as the texel lies from them; itself where outside."""
    row, column = np.divmod(texel, shape[1])
    candidates = []
    for down, right in ((0, 0), (0, 1), (1, 0), (1, 1)):
        lattice_row = np.minimum(row // _STRIDE + down, found.shape[0] - 1)
        lattice_column = np.minimum(column // _STRIDE + right, found.shape[1] - 1)
        there_row, there_column = np.divmod(found[lattice_row, lattice_column], shape[1])
        there_row += (row - lattice_row * _STRIDE)[:, None]
        there_column += (column - lattice_column * _STRIDE)[:, None]
        inside = (there_row >= 0) & (there_row < shape[0]) & (there_column >= 0) & (there_column < shape[1])
        there = np.where(inside, there_row * shape[1] + there_column, texel[:, None])
        candidates.append(there if usable is None else np.where(usable.ravel()[there], there, texel[:, None]))
    return np.concatenate(candidates, axis=1)


def _cheapest_apart(
    texel: Int64[np.ndarray, "texel"],
    candidates: Int64[np.ndarray, "texel candidate"],
    vectors: Float32[np.ndarray, "row column component"],
    count: int,
    apart: int,
) -> Int64[np.ndarray, "texel k"]:
    """The cheapest candidate, then the cheapest of those far enough from it, and so on; ties take the lowest texel."""
    columns = vectors.shape[1]
    flat = vectors.reshape(-1, vectors.shape[2])
    candidates = np.sort(candidates, axis=1)
    difference = flat[candidates] - flat[texel][:, None]
    cost = np.einsum("ijk,ijk->ij", difference, difference)
    row, column = np.divmod(candidates, columns)
    chosen = np.empty((len(texel), count), np.int64)
    last = texel
    for turn in range(count):
        last_row, last_column = np.divmod(last, columns)
        near = np.maximum(np.abs(row - last_row[:, None]), np.abs(column - last_column[:, None])) < apart
        cost[near] = np.inf
        best = cost.argmin(axis=1)
        some = np.isfinite(cost[np.arange(len(texel)), best])
        last = np.where(some, candidates[np.arange(len(texel)), best], last)
        chosen[:, turn] = last
    return chosen
