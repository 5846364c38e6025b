"""Pictures of the sources themselves: where each site's texture comes from, and where copied pieces meet."""

import numpy as np
from jaxtyping import Bool, Float, Float32, Int

from texloom.sources import SourceMap

_BORDER = np.array([1.0, 0.03, 0.0], np.float32)  # linear red
_APART = 0.75  # texels; sources that disagree by more show different parts of the exemplar


def source_colours(sources: SourceMap, shape: tuple[int, int]) -> Float32[np.ndarray, "site 3"]:
    """Where the heaviest source of each site lies in an exemplar of ``shape`` texels: linear colours that vary slowly.

    Red runs along columns, green along rows, blue falls along the diagonal. Equal colours are equal places.
    """
    rows, columns = shape
    down = sources.position[:, 0, 0] / max(rows - 1, 1)
    across = sources.position[:, 0, 1] / max(columns - 1, 1)
    colours = np.stack([across, down, 1.0 - 0.5 * (across + down)], axis=1)
    return np.clip(colours, 0.0, 1.0).astype(np.float32) ** np.float32(2.2)


def broken_edges(
    sources: SourceMap, edges: Int[np.ndarray, "edge 2"], offsets: Float[np.ndarray, "edge 2"]
) -> Bool[np.ndarray, "edge"]:
    """Whether the heaviest sources at the two ends of an edge show different parts of the exemplar.

    ``offsets`` lead from the first site to the second, in [row, column] texels and in the first site's frame.
    """
    one, other = edges.T
    turn = np.zeros(len(edges)) if sources.turn is None else sources.turn[one, 0]
    scale = np.ones(len(edges)) if sources.scale is None else sources.scale[one, 0]
    cosine, sine = np.cos(turn) / scale, np.sin(turn) / scale
    expected = np.stack(
        [cosine * offsets[:, 0] + sine * offsets[:, 1], cosine * offsets[:, 1] - sine * offsets[:, 0]], axis=1
    )
    found = sources.position[other, 0] - sources.position[one, 0]
    return (np.abs(found - expected) > _APART).any(axis=1)


def grid_edges(rows: int, columns: int) -> tuple[Int[np.ndarray, "edge 2"], Float32[np.ndarray, "edge 2"]]:
    """Edges of a grid to the right and down, with their offsets."""
    site = np.arange(rows * columns).reshape(rows, columns)
    right = np.stack([site[:, :-1].ravel(), site[:, 1:].ravel()], axis=1)
    down = np.stack([site[:-1].ravel(), site[1:].ravel()], axis=1)
    steps = np.repeat(np.array([[0, 1], [1, 0]], np.float32), [len(right), len(down)], axis=0)
    return np.concatenate([right, down]), steps


def with_borders(
    colours: Float32[np.ndarray, "site 3"], edges: Int[np.ndarray, "edge 2"], broken: Bool[np.ndarray, "edge"]
) -> Float32[np.ndarray, "site 3"]:
    """Colours with every site at the first end of a broken edge in red."""
    marked = colours.copy()
    marked[edges[broken, 0]] = _BORDER
    return marked
