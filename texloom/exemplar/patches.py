"""Square patches of an exemplar as vectors to search among (Chen, Liu & Dong, section 4.1.2)."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float32, Int32

from texloom.arrays import Image
from texloom.errors import ExemplarError, ParameterError
from texloom.exemplar.blas import over_blocks

_BLOCK = 256  # patches gathered at once


@dataclass(frozen=True, eq=False)
class PatchVectors:
    """Every usable patch as one row: its sample values, sample by sample, and its top-left texel [row, column]."""

    vectors: Float32[np.ndarray, "patch dim"]
    anchors: Int32[np.ndarray, "patch 2"]


def patch_vectors(
    image: Image,
    width: int,
    samples: Int32[np.ndarray, "sample 2"],
    *,
    step: int = 1,
    usable: Bool[np.ndarray, "row column"] | None = None,
) -> PatchVectors:
    """All ``width × width`` patches with a usable texel everywhere, read at ``samples`` (offsets from the top left).

    ``step`` keeps every so many rows and columns. Anchors run row by row.

    Raises: ExemplarError, if the image is smaller than a patch or the mask leaves no whole patch.
    """
    anchors = patch_anchors(image.shape[:2], width, step=step, usable=usable)
    columns, channels = image.shape[1:]
    texels = image.reshape(-1, channels)
    corner = anchors[:, 0] * columns + anchors[:, 1]
    offset = samples[:, 0] * columns + samples[:, 1]
    vectors = np.empty((len(anchors), len(samples) * channels), np.float32)

    def gather(first: int, last: int) -> None:
        texels.take(
            corner[first:last, None] + offset, axis=0, out=vectors[first:last].reshape(-1, len(samples), channels)
        )

    over_blocks(gather, len(anchors), _BLOCK)
    return PatchVectors(vectors, anchors)


def patch_anchors(
    shape: tuple[int, ...], width: int, *, step: int = 1, usable: Bool[np.ndarray, "row column"] | None = None
) -> Int32[np.ndarray, "patch 2"]:
    """Top-left texels [row, column] of the patches that lie inside the image and inside the mask, row by row."""
    rows, columns = shape[0] - width + 1, shape[1] - width + 1
    if min(rows, columns) < 1:
        raise ExemplarError(
            f"the exemplar is {shape[1]}x{shape[0]} texels, but a patch needs {width}x{width}: "
            "lower the patch width or use a larger sample"
        )
    if usable is None:
        usable = np.ones(shape[:2], bool)
    whole = whole_squares(usable, width)
    row, column = np.nonzero(whole[::step, ::step])
    if len(row) == 0:
        raise ExemplarError(
            f"no {width}x{width} patch lies inside the mask, which keeps {int(np.count_nonzero(usable))} of "
            f"{shape[0] * shape[1]} texels: lower the patch width or widen the mask"
        )
    return np.stack([row, column], axis=1).astype(np.int32) * np.int32(step)


def even_samples(width: int, side: int) -> Int32[np.ndarray, "sample 2"]:
    """``side × side`` representative samples [row, column], spread evenly over a patch."""
    if not 1 <= side <= width:
        raise ParameterError(f"a patch of {width}x{width} texels cannot have {side}x{side} samples: use 1 to {width}")
    position = ((2 * np.arange(side) + 1) * width // (2 * side)).astype(np.int32)
    return np.stack(np.meshgrid(position, position, indexing="ij"), axis=-1).reshape(-1, 2)


def boundary_samples(width: int, zone: int, *, step: int = 1) -> Int32[np.ndarray, "sample 2"]:
    """Samples [row, column] within ``zone`` texels of the patch's border, every ``step``-th of each row, staggered.

    Chen, Liu & Dong, section 5: the boundary zone of width w_E.
    """
    if not 1 <= zone <= width:
        raise ParameterError(f"a boundary zone of {zone} texels does not fit a patch of {width}: use 1 to {width}")
    row, column = np.indices((width, width)).reshape(2, -1)
    inward = np.minimum(np.minimum(row, column), width - 1 - np.maximum(row, column))
    keep = (inward < zone) & ((row + column) % step == 0)
    return np.stack([row[keep], column[keep]], axis=1).astype(np.int32)


def whole_squares(usable: Bool[np.ndarray, "row column"], width: int) -> Bool[np.ndarray, "anchor_row anchor_column"]:
    """Where the square below and right of a texel is wholly usable, by a summed-area table; empty if none fits in."""
    total = np.zeros((usable.shape[0] + 1, usable.shape[1] + 1), np.int64)
    total[1:, 1:] = usable.cumsum(axis=0).cumsum(axis=1)
    inside = total[width:, width:] - total[:-width, width:] - total[width:, :-width] + total[:-width, :-width]
    return inside == width * width
