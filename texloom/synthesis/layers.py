"""From anchors of overlapping patches to the sources of each site."""

import numpy as np
from jaxtyping import Float32, Int32

from texloom.domain.domain import Domain
from texloom.domain.patches import Patches
from texloom.kernels.averaging import feather_layers, heaviest_patches, place_sources
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
    shape: tuple[int, int],
) -> SourceMap:
    """Each site shows the mean of its heaviest patches."""
    entry, share = _empty(patches)
    launch(
        heaviest_patches,
        len(entry),
        inputs=[patches.cover_start, patches.cover_patch, weight],
        outputs=[entry, share],
    )
    return _sources(domain, patches, anchors, entry, share, shape)


def feathered(
    domain: Domain,
    patches: Patches,
    anchors: Int32[np.ndarray, "patch 2"],
    rank: Int32[np.ndarray, "patch"],
    zone: int,
    shape: tuple[int, int],
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
    return _sources(domain, patches, anchors, entry, share, shape)


def _empty(patches: Patches) -> tuple[Int32[np.ndarray, "site k"], Float32[np.ndarray, "site k"]]:
    sites = len(patches.cover_start) - 1
    return np.empty((sites, MOST), np.int32), np.empty((sites, MOST), np.float32)


def _sources(
    domain: Domain,
    patches: Patches,
    anchors: Int32[np.ndarray, "patch 2"],
    entry: Int32[np.ndarray, "site k"],
    share: Float32[np.ndarray, "site k"],
    shape: tuple[int, int],
) -> SourceMap:
    """Sources of the given cover entries, heaviest first; sites that no patch covers continue their neighbours'."""
    position = np.empty((*entry.shape, 2), np.float32)
    turned = patches.cover_turn is not None
    turn = np.zeros(entry.shape if turned else (1, 1), np.float32)
    launch(
        place_sources,
        len(entry),
        inputs=[
            *(entry, patches.cover_patch, patches.cover_position),
            *(patches.cover_turn if turned else np.zeros(1, np.float32), anchors),
        ],
        outputs=[share, position, turn],
    )
    bare = np.diff(patches.cover_start) == 0
    if bare.any():
        lead = np.ascontiguousarray(turn[:, 0]) if turned else np.zeros(len(entry), np.float32)
        fill_gaps(domain, ~bare, position[:, 0], lead, shape)
        if turned:
            turn[:, 0] = lead
    return SourceMap(position, share, turn if turned else None)
