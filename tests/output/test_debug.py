"""Pictures of sources: coherent pieces have no inner border."""

import numpy as np

from texloom.output.debug import broken_edges, grid_edges, source_colours, with_borders
from texloom.output.gather import identity_sources
from texloom.sources import SourceMap


def test_a_copy_has_no_borders_and_a_shifted_half_has_one():
    sources = identity_sources(6, 8)
    edges, offsets = grid_edges(6, 8)
    assert not broken_edges(sources, edges, offsets).any()
    position = sources.position.reshape(6, 8, 1, 2).copy()
    position[:, 4:] += 3
    shifted = SourceMap(position.reshape(48, 1, 2), sources.weight)
    broken = broken_edges(shifted, edges, offsets)
    assert broken.sum() == 6 and (edges[broken] % 8 == [3, 4]).all()
    colours = source_colours(shifted, (6, 8))
    marked = with_borders(colours, edges, broken).reshape(6, 8, 3)
    assert (marked[:, 3] == marked[0, 3]).all() and (colours >= 0).all() and (colours <= 1).all()


def test_turned_sources_are_coherent_along_their_turn():
    turn = 0.6
    sites = np.stack(np.meshgrid(np.arange(5.0), np.arange(5.0), indexing="ij"), axis=-1).reshape(-1, 2)
    rotation = np.array([[np.cos(turn), np.sin(turn)], [-np.sin(turn), np.cos(turn)]])
    position = (sites @ rotation.T)[:, None].astype(np.float32)
    weight, turns = np.ones((25, 1), np.float32), np.full((25, 1), turn, np.float32)
    edges, offsets = grid_edges(5, 5)
    assert not broken_edges(SourceMap(position, weight, turns), edges, offsets).any()
    assert broken_edges(SourceMap(position, weight, -2 * turns), edges, offsets).any()
