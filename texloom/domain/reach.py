"""The cover of traced patches: where every site lies in the patches around it."""

import numpy as np
from jaxtyping import Bool, Complex64, Float32, Int32

from texloom.domain.cover import group_by_site
from texloom.field.trace import Flow, Samples
from texloom.kernels.launch import launch
from texloom.kernels.reach import nearest_of_patch, sites_in_cells, unfold_around

Cover = tuple[
    Int32[np.ndarray, "sites_plus_one"],
    Int32[np.ndarray, "entry"],
    Float32[np.ndarray, "entry 2"],
    Float32[np.ndarray, "entry"] | None,
]
"""Start, patch, position and turn, as in ``Patches``."""


def cover_of(flow: Flow, samples: Samples, width: int, axis: Complex64[np.ndarray, "face 3"]) -> Cover:
    """Every site's position in every patch: that of the patch's nearest sample, and the offset from it.

    ``axis`` is the site's frame at every face corner, as a direction in the face.

    The offset is measured in the sample's frame, on triangles laid flat around it: first order, exact where the field
    is straight. Ties keep the lowest sample. Positions end half a texel outside the patch's outer samples, and one
    texel beyond a sample whose neighbour could not be traced. The turn is a multiple of ``2π / order``: the patch's
    axes are those of the field's directions at the site that continue the patch's.

    Departure: the paper finds the quad of samples around a site and inverts it by a rule of two triangles (fig. 3c).
    """
    sample, site, offset, steps = _cells(flow, samples, width, axis)
    start, order = group_by_site(site, len(flow.position))
    keep = _nearest(width * width, start, order, sample, offset)
    kept = order[keep]
    start = np.append(np.zeros(1, np.int32), np.cumsum(keep, dtype=np.int32))[start]
    patch, at = np.divmod(sample[kept], np.int32(width * width))
    position = np.stack(np.divmod(at, np.int32(width)), axis=1, dtype=np.float32, casting="unsafe") + offset[kept]
    if flow.order == 1:
        return start, patch, position, None
    turns = (np.arange(flow.order) + (flow.order - 1) // 2) % flow.order - (flow.order - 1) // 2
    return start, patch, position, (turns * (2 * np.pi / flow.order)).astype(np.float32)[steps[kept]]


def _cells(
    flow: Flow, samples: Samples, width: int, axis: Complex64[np.ndarray, "face 3"]
) -> tuple[
    Int32[np.ndarray, "entry"], Int32[np.ndarray, "entry"], Float32[np.ndarray, "entry 2"], Int32[np.ndarray, "entry"]
]:
    """Sample, site, offset and turn (in n-ths) of every site in every sample's cell; the cells overlap a little."""
    around = _surroundings(flow, samples, axis)
    inputs = [flow.record, flow.order, width, *around, samples.face, samples.place, samples.heading]
    count, nothing = np.empty(len(samples.face), np.int32), np.empty(0, np.int32)
    launch(
        sites_in_cells,
        len(count),
        inputs=[*inputs, nothing],
        outputs=[count, nothing, np.empty((0, 2), np.float32), nothing],
    )
    ends = np.cumsum(count, dtype=np.int32)
    total = int(ends[-1]) if len(ends) else 0
    site, offset, steps = np.empty(total, np.int32), np.empty((total, 2), np.float32), np.zeros(total, np.int32)
    launch(sites_in_cells, len(count), inputs=[*inputs, ends - count], outputs=[count, site, offset, steps])
    return np.repeat(np.arange(len(count), dtype=np.int32), count), site, offset, steps


def _surroundings(
    flow: Flow, samples: Samples, axis: Complex64[np.ndarray, "face 3"]
) -> tuple[
    Int32[np.ndarray, "face"],
    Int32[np.ndarray, "face"],
    Int32[np.ndarray, "entry"],
    Float32[np.ndarray, "entry 2"],
    Float32[np.ndarray, "framed 2"],
]:
    """Sites around every face that holds a sample: the first one's entry and their number, then for each entry the
    site, its place and (for a symmetric field) its frame in the face's frame."""
    face_count, nothing = len(flow.faces), np.empty(0, np.int32)
    wanted = np.zeros(face_count, np.uint8)
    wanted[samples.face[samples.face >= 0]] = 1
    frames = np.ascontiguousarray(axis).view(np.float32).reshape(-1, 3, 2)
    inputs = [flow.record, flow.twin, flow.faces, frames, wanted, flow.order]
    count, no_points = np.empty(face_count, np.int32), np.empty((0, 2), np.float32)
    launch(unfold_around, face_count, inputs=[*inputs, nothing], outputs=[count, nothing, no_points, no_points])
    ends = np.cumsum(count, dtype=np.int32)
    total = int(ends[-1]) if face_count else 0
    site, place = np.empty(total, np.int32), np.empty((total, 2), np.float32)
    frame = np.empty((total if flow.order > 1 else 0, 2), np.float32)
    launch(unfold_around, face_count, inputs=[*inputs, ends - count], outputs=[count, site, place, frame])
    return ends - count, count, site, place, frame


def _nearest(
    samples: int,
    start: Int32[np.ndarray, "sites_plus_one"],
    order: Int32[np.ndarray, "entry"],
    sample: Int32[np.ndarray, "entry"],
    offset: Float32[np.ndarray, "entry 2"],
) -> Bool[np.ndarray, "entry"]:
    """Which entries, in ``order``, are the nearest of their site and patch."""
    keep = np.zeros(len(order), np.uint8)
    launch(nearest_of_patch, len(start) - 1, inputs=[samples, start, order, sample, offset], outputs=[keep])
    return keep.view(bool)
