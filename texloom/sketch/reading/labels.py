"""A picture of labels to lines: the borders between its regions."""

import numpy as np
from jaxtyping import Int

from texloom.sketch.reading.lines import Lines, joined, noded, tidy

_SHORTER = 1.0, 0.5, 0.25  # of what is short: where short chains would run together
_SAME = 1e-3  # texels between vertices that are one


def borders(labels: Int[np.ndarray, "row column"], *, shortest: float) -> Lines:
    """The borders between regions as a planar drawing, in texels: through the middles of the texels' sides.

    Borders end at the picture's edge. Between forks less than ``shortest`` texels apart the border is drawn together to
    one, so four regions that meet in a cross have one vertex.
    """
    lines = _cracks(labels)
    if len(lines.edges) == 0:
        return lines
    lines = _through_middles(lines)
    group = drawn_together(lines, shortest)
    together = _straight_to(lines.collapsed(group), _moved(lines, group), radius=shortest)
    return noded(together.vertices, together.edges, weld=_SAME)


def drawn_together(lines: Lines, shortest: float) -> Int[np.ndarray, "vertex"]:
    """Groups of forks that short chains join, none much larger than a short chain: in a larger one, shorter chains."""
    chains = lines.chains
    of = np.repeat(np.arange(len(chains)), np.diff(chains.start))
    forks = (lines.degree[chains.ends] > 2).all(axis=1) & (chains.ends[:, 0] != chains.ends[:, 1])
    links = np.zeros((0, 2), np.int64)
    for length in shortest * np.array(_SHORTER):
        short = forks & (lines.lengths < length)
        along = short[of[1:]] & (of[1:] == of[:-1])
        joins = np.stack([chains.vertex[:-1][along], chains.vertex[1:][along]], axis=1)
        group = joined(len(lines.vertices), joins)
        low, high = np.full((group.max() + 1, 2), np.inf), np.full((group.max() + 1, 2), -np.inf)
        np.minimum.at(low, group, lines.vertices)
        np.maximum.at(high, group, lines.vertices)
        small = (high - low).max(axis=1) <= 2 * length
        links = np.concatenate([links, joins[small[group[joins[:, 0]]]]])
        forks &= ~(short & small[group[chains.ends[:, 0]]])
    return joined(len(lines.vertices), links)


def _moved(lines: Lines, group: Int[np.ndarray, "vertex"]) -> np.ndarray:
    """Where forks were drawn together."""
    count = np.bincount(group)
    mean = np.stack([np.bincount(group, lines.vertices[:, axis]) / count for axis in (0, 1)], axis=1)
    return mean[count > 1]


def _straight_to(lines: Lines, forks: np.ndarray, *, radius: float) -> Lines:
    """Chains that end at these forks go straight there from ``radius`` away, not by way of where they went before."""
    from scipy.spatial import KDTree

    chains = lines.chains
    if not len(forks) or not len(chains):
        return lines
    point = lines.vertices[chains.vertex]
    moved = np.isin(np.arange(len(lines.vertices)), KDTree(lines.vertices).query(forks)[1])
    of = np.repeat(np.arange(len(chains)), np.diff(chains.start))
    kept = np.ones(len(point), bool)
    for end in chains.ends.T:
        gap = np.hypot(*(point - lines.vertices[end][of]).T)
        kept &= ~(moved[end][of] & (gap < radius))
    kept[chains.start[:-1]] = kept[chains.start[1:] - 1] = True
    vertex, of = chains.vertex[kept], of[kept]
    same = of[1:] == of[:-1]
    return tidy(lines.vertices, np.stack([vertex[:-1][same], vertex[1:][same]], axis=1))


def _cracks(labels: np.ndarray) -> Lines:
    """Sides of texels between two labels; vertices are corners of texels."""
    rows, columns = labels.shape
    width = columns + 1
    r, c = np.nonzero(labels[1:] != labels[:-1])
    flat = np.stack([(r + 1) * width + c, (r + 1) * width + c + 1], axis=1)
    r, c = np.nonzero(labels[:, 1:] != labels[:, :-1])
    upright = np.stack([r * width + c + 1, (r + 1) * width + c + 1], axis=1)
    corner = np.arange((rows + 1) * width)
    return tidy(np.stack([corner // width - 0.5, corner % width - 0.5], axis=1), np.concatenate([flat, upright]))


def _through_middles(lines: Lines) -> Lines:
    """Each chain through the middles of its edges, its ends held: steps become slopes."""
    chains = lines.chains
    vertex, count = chains.vertex, np.diff(chains.start)
    chain = np.repeat(np.arange(len(count)), count)
    point = lines.vertices[vertex]
    inner = np.flatnonzero(chain[1:] == chain[:-1])
    middles = (point[inner] + point[inner + 1]) / 2
    opens = chains.start[:-1] - np.arange(len(count))  # each chain has one middle fewer than vertices
    closes = np.append(opens[1:], len(inner)) - 1
    number = len(lines.vertices) + np.arange(len(inner))
    ring = (chains.ends[:, 0] == chains.ends[:, 1]) & (lines.degree[chains.ends[:, 0]] == 2)
    between = np.flatnonzero(chain[inner][1:] == chain[inner][:-1])
    edges = [np.stack([number[between], number[between + 1]], axis=1)]
    edges.append(np.stack([chains.ends[~ring, 0], number[opens[~ring]]], axis=1))
    edges.append(np.stack([number[closes[~ring]], chains.ends[~ring, 1]], axis=1))
    edges.append(np.stack([number[closes[ring]], number[opens[ring]]], axis=1))
    return tidy(np.concatenate([lines.vertices, middles]), np.concatenate(edges))
