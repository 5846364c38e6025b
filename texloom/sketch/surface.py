"""Cells carried over surfaces: a texture designed by a sketch takes the place of its samples, and they come back."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float32

from texloom.exemplar.exemplar import Exemplar
from texloom.output.gather import gather_images
from texloom.sketch.design import Design
from texloom.sources import SourceMap


@dataclass(frozen=True, eq=False)
class Designed:
    """A designed texture as an exemplar, with all maps of its samples, and the source of every texel in those."""

    exemplar: Exemplar
    sources: SourceMap

    @staticmethod
    def of(design: Design) -> "Designed":
        """The texture of a design."""
        sources = design.sources
        rows, columns = design.mesh.size
        return Designed(Exemplar(gather_images(sources, design.sample.exemplar, rows=rows, columns=columns)), sources)

    def in_samples(self, sources: SourceMap) -> SourceMap:
        """Sources in the designed texture as sources in the samples."""
        return composed(sources, self.sources, self.exemplar.shape)


def composed(outer: SourceMap, inner: SourceMap, shape: tuple[int, int]) -> SourceMap:
    """Sources in a texture of ``shape``, and its texels' own (``inner``, one each, in row order), as one step.

    The texel n nearest to a source shows p' + R(t') (q - n) / s' at q, so ``offset`` from a site at p, t, s shows
    p' + R(t') (p - n) / s' + R(t + t') offset / (s s').
    """
    rows, columns = shape
    nearest = np.rint(outer.position).clip(0, np.array([rows - 1, columns - 1])).astype(np.int64)
    texel = nearest[..., 0] * columns + nearest[..., 1]
    turn = np.zeros(texel.shape, np.float32) if inner.turn is None else inner.turn[texel, 0]
    scale = np.ones(texel.shape, np.float32) if inner.scale is None else inner.scale[texel, 0]
    beside = _turned((outer.position - nearest).astype(np.float32), turn) / scale[..., None]
    return SourceMap(
        inner.position[texel, 0] + beside,
        outer.weight,
        turn if outer.turn is None else turn + outer.turn,
        scale if outer.scale is None else scale * outer.scale,
    )


def _turned(
    offset: Float32[np.ndarray, "site k 2"], turn: Float32[np.ndarray, "site k"]
) -> Float32[np.ndarray, "site k 2"]:
    """R(turn) on [row, column]."""
    cosine, sine = np.cos(turn), np.sin(turn)
    row, column = offset[..., 0], offset[..., 1]
    return np.stack([row * cosine + column * sine, column * cosine - row * sine], axis=-1)
