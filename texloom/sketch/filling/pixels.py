"""The last step: texels near lines, or drawn out, choose anew; neighbourhoods turn as lines do (§3.2, fig. 13).

A neighbourhood of the sample is turned by its own orientation feature, one of the texture by its; what counts is the
angle between the two, and that is a source's turn. So the texture's neighbourhoods stay upright, and only the sample's
are turned, by the difference.
"""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float32, Int32, UInt8

from texloom.arrays import Image
from texloom.domain.grid import Grid
from texloom.domain.neighbourhoods import Neighbourhoods, as_stencils
from texloom.errors import ParameterError
from texloom.exemplar.exemplar import Exemplar
from texloom.exemplar.similarity import most_alike
from texloom.sketch.filling.maps import FeatureMaps, Window
from texloom.sketch.filling.warp import Start
from texloom.synthesis.canvas import Canvas
from texloom.synthesis.correction import usable_centres
from texloom.synthesis.visits import Guide, Visits

_LINE, _INSIDE = 1, 2  # kinds of texels: near an edge, and elsewhere; above, the insides of further kinds of cells
_MOST_KINDS = 250
_BESIDE = 3  # texels from lines where texels still choose


@dataclass(frozen=True, kw_only=True)
class PixelSynthesis:
    """Every texel near a line or drawn out takes the texel whose neighbourhood fits its own best, in ``passes``.

    Candidates are what the texels around continue and ``alike`` texels most like the own one; near lines only what lies
    near lines in the sample, elsewhere what lies in cells of the same kind. With ``turned`` texels near lines
    begin, and alike texels come, turned as their line runs against this one; without, as they lie.
    """

    passes: int = 1
    window: int = 5  # texels a side of the neighbourhoods compared, odd
    sparse: bool = True  # of these only every other texel, as on a chessboard: half the time, and no less sharp
    turned: bool = True
    alike: int = 1

    def __post_init__(self) -> None:
        if self.window < 3 or self.window % 2 == 0:
            raise ParameterError(f"window {self.window} must be odd and 3 or more")
        if min(self.passes, self.alike) < 0:
            raise ParameterError(f"passes {self.passes} and alike {self.alike} must be 0 or more")

    def guide(
        self, exemplar: Exemplar, image: Image, maps: FeatureMaps, kinds: Int32[np.ndarray, "sample_cell"]
    ) -> Guide:
        """What is learnt from the sample, once: where each kind of texel lies, texels alike, how lines run."""
        usable = usable_centres(image, exemplar, self.window // 2) * _regions(maps, kinds)
        similar = np.zeros((*image.shape[:2], 0, 2), np.int32)
        if self.alike:
            similar = most_alike(image, self.alike, usable=exemplar.mask)
        return Guide(image, usable, similar, axis=_angles(maps.toward) if self.turned else None)

    def run(self, guide: Guide, maps: FeatureMaps, start: Start, kinds: Int32[np.ndarray, "cell"]) -> Canvas:
        """The texture, in the order of its rows."""
        rows, columns = maps.shape
        canvas = Canvas.empty(rows * columns, guide.image.shape[2])
        canvas.label[:] = 0
        self.again(canvas, guide, maps, start, kinds, window=(slice(0, rows), slice(0, columns)))
        return canvas

    def again(
        self,
        canvas: Canvas,
        guide: Guide,
        maps: FeatureMaps,
        start: Start,
        kinds: Int32[np.ndarray, "cell"],
        *,
        window: Window,
    ) -> None:
        """The texels of a window from their start on, in place."""
        rows, columns = maps.shape
        grid = Grid(rows, columns, maps.wrap)
        sites = np.arange(grid.count, dtype=np.int32).reshape(rows, columns)[window]
        inside = sites.ravel()
        canvas.position[inside] = start.position[window].reshape(-1, 2)
        canvas.turn[inside] = start.turn[window].ravel()
        bent, turns = start.drawn_out(window, wrap=maps.wrap)
        if self.passes and guide.axis is not None:
            canvas.turn[sites[bent]] = turns
            near = inside[maps.closeness[window].ravel() > 0]
            row, column = np.rint(canvas.position[near]).astype(np.int32).T
            canvas.turn[near] = guide.axis[row, column] - _angles(maps.toward.reshape(-1, 2)[near])
        canvas.look(guide.image, inside)
        chosen = sites[bent | (maps.away[window] <= maps.reach + _BESIDE)]
        around = grid.neighbourhoods(chosen, self.window // 2)
        samples = _every_other(around) if self.sparse else None
        visits = Visits(guide, canvas, around, as_stencils(around), samples, kind=_regions(maps, kinds).ravel())
        part = chosen // columns % 2 * 2 + chosen % columns % 2  # no two of one part are neighbours
        for _ in range(self.passes):
            for number in range(4):
                visits.at_once(np.flatnonzero(part == number).astype(np.int32))


def _every_other(around: Neighbourhoods) -> Int32[np.ndarray, "sample"]:
    """The samples of a grid's neighbourhoods that are as dark as their middle on a chessboard."""
    return np.flatnonzero(np.rint(around.offset[0]).sum(axis=1) % 2 == 0).astype(np.int32)


def _regions(maps: FeatureMaps, kinds: Int32[np.ndarray, "cell"]) -> UInt8[np.ndarray, "row column"]:
    """The kind of every texel: near an edge, or in a cell of a kind."""
    of_cell = _INSIDE + np.minimum(np.append(kinds, 0), _MOST_KINDS).astype(np.uint8)
    return np.where(maps.closeness > 0, np.uint8(_LINE), of_cell[maps.cell])


def _angles(toward: Float32[np.ndarray, "*shape 2"]) -> Float32[np.ndarray, "*shape"]:
    """The angle of an orientation feature: R(angle) takes [1, 0] to its direction."""
    return np.arctan2(-toward[..., 1], toward[..., 0])
