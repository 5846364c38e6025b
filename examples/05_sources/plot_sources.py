"""Where the texture comes from.

Left the result; middle each texel's place in the sample as a colour (the small square is the sample's own); right the
borders, in red, where copied pieces meet. Pieces are large, so content is kept; borders are irregular, so they hide.
"""

import numpy as np

import texloom
from examples.pictures import Picture, beside, inset, shown
from texloom.demo import draw
from texloom.output.debug import broken_edges, grid_edges, source_colours, with_borders
from texloom.output.gather import gather_sites, identity_sources
from texloom.output.image import encoded_picture


def picture(detail: float = 1.0) -> Picture:
    """Three pictures in a row; ``detail`` scales their sides."""
    side = round(448 * detail)
    sample = draw("pebbles", size=192)
    sources = texloom.synthesize(sample, texloom.Grid(side, side), seed=1).sources
    edges, offsets = grid_edges(side, side)
    marked = with_borders(gather_sites(sources, sample.lead), edges, broken_edges(sources, edges, offsets))
    own = source_colours(identity_sources(*sample.shape), sample.shape).reshape(*sample.shape, 3)
    places = encoded_picture(source_colours(sources, sample.shape).reshape(side, side, 3))
    bordered = encoded_picture(np.ascontiguousarray(marked).reshape(side, side, 3))
    return beside(shown(sources, sample, (side, side)), inset(places, encoded_picture(own)), bordered)
