"""From anchors of overlapping patches to the sources of each site."""

import numpy as np
from jaxtyping import Float32, Int32

from texloom.domain.domain import Domain
from texloom.domain.patches import Patches
from texloom.kernels.averaging import feather_layers, heaviest_patches
from texloom.kernels.launch import launch
from texloom.sources import SourceMap
from texloom.synthesis.gaps import fill_gaps

MOST = 4
"""Sources a site keeps."""


def heaviest(
    domain: Domain,
    patches: Patches,
    anchors: Int32[np.ndarray, "patch 2"],
    weight: Float32[np.ndarray, "patch"],
    scale: float,
) -> SourceMap:
    """Each site shows the mean of its heaviest patches; ``scale`` is exemplar texels a texel of the anchors."""
    entry, share = _empty(patches)
    launch(
        heaviest_patches,
        len(entry),
        inputs=[patches.cover_start, patches.cover_patch, weight],
        outputs=[entry, share],
    )
    return _sources(domain, patches, anchors, scale, entry, share)


def feathered(
    domain: Domain, patches: Patches, anchors: Int32[np.ndarray, "patch 2"], rank: Int32[np.ndarray, "patch"], zone: int
) -> SourceMap:
    """Each site shows the patches laid over it, the latest on top, blended over ``zone`` samples at their borders."""
    entry, share = _empty(patches)
    launch(
        feather_layers,
        len(entry),
        inputs=[
            *(patches.cover_start, patches.cover_patch, patches.cover_position),
            *(rank, patches.width, float(zone)),
        ],
        outputs=[entry, share],
    )
    return _sources(domain, patches, anchors, 1.0, entry, share)


def _empty(patches: Patches) -> tuple[Int32[np.ndarray, "site k"], Float32[np.ndarray, "site k"]]:
    sites = len(patches.cover_start) - 1
    return np.empty((sites, MOST), np.int32), np.empty((sites, MOST), np.float32)


def _sources(
    domain: Domain,
    patches: Patches,
    anchors: Int32[np.ndarray, "patch 2"],
    scale: float,
    entry: Int32[np.ndarray, "site k"],
    share: Float32[np.ndarray, "site k"],
) -> SourceMap:
    """Sources of the given cover entries, heaviest first; sites that no patch covers continue their neighbours'."""
    order = np.argsort(-share, axis=1, kind="stable")
    entry, share = np.take_along_axis(entry, order, 1), np.take_along_axis(share, order, 1)
    position = anchors[patches.cover_patch[entry]] * np.float32(scale) + patches.cover_position[entry]
    turn = np.zeros_like(share) if patches.cover_turn is None else patches.cover_turn[entry]
    position[entry < 0], turn[entry < 0] = 0.0, 0.0
    bare = entry[:, 0] < 0
    fill_gaps(domain, ~bare, position[:, 0], turn[:, 0])
    share[:, 0] += 1.0 - share.sum(1)  # whole where nothing covers, and where rounding left a little
    return SourceMap(position, share, turn if turn.any() else None)
