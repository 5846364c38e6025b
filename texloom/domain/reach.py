"""The cover of traced patches: where every site lies in the patches around it."""

from dataclasses import dataclass, field

import numpy as np
from jaxtyping import Complex64, Float32, Int8, Int32

from texloom.field.trace import Flow, Samples
from texloom.kernels.launch import launch
from texloom.kernels.reach import collect_entries, cover_squares, group_cover

Cover = tuple[
    Int32[np.ndarray, "sites_plus_one"],
    Int32[np.ndarray, "entry"],
    Float32[np.ndarray, "entry 2"],
    Float32[np.ndarray, "entry"] | None,
]
"""Start, patch, position and turn, as in ``Patches``."""

_LEAST_ROOM = 4  # sites for each sample of a patch, and twice as many faces; doubled until it is enough


@dataclass(eq=False)
class Covering:
    """Every site's position in every patch: that of the patch's nearest sample around it, and the offset from that.

    ``axis`` is the site's frame at every face corner, as a direction in the face. Patches are added in batches, in
    order; ``cover`` turns them inside out.

    The offset is measured in the sample's frame, on triangles laid flat around it: first order, exact where the field
    is straight. Ties keep the lowest sample. Positions end half a texel outside the patch's outer samples, and one
    texel beyond a sample whose neighbour could not be traced. The turn is a multiple of ``2π / order``: the patch's
    axes are those of the field's directions at the site that continue the patch's.

    Departure: the paper finds the quad of samples around a site and inverts it by a rule of two triangles (fig. 3c).
    """

    flow: Flow
    width: int
    axis: Complex64[np.ndarray, "face 3"]
    _batches: list["_Entries"] = field(default_factory=list)
    _tables: "_Tables | None" = None

    def add(self, samples: Samples) -> None:
        """The next patches; about half the cost of tracing them."""
        flow, samples_of_patch = self.flow, self.width * self.width
        patches = len(samples.face) // samples_of_patch
        if self._tables is None or self._tables.patches < patches:
            self._tables = _Tables(patches, _LEAST_ROOM * samples_of_patch)
        frames = np.ascontiguousarray(self.axis).view(np.float32).reshape(-1, 3, 2)
        inputs = [flow.record, flow.twin, flow.faces, frames, flow.order, self.width]
        count = np.empty(patches, np.int32)
        while True:
            traced = [samples.face, samples.place, samples.heading]
            outputs = [*self._tables.scratch, count, *self._tables.found]
            launch(cover_squares, patches, inputs=[*inputs, *traced], outputs=outputs)
            if (count >= 0).all():
                break
            self._tables = _Tables(self._tables.patches, 2 * self._tables.room)
        first = np.append(np.zeros(1, np.int32), np.cumsum(count, dtype=np.int32))
        entries = _Entries.empty(count, steps=flow.order > 1)
        launch(
            collect_entries,
            patches,
            inputs=[flow.order, self.width, first, *self._tables.found],
            outputs=[entries.site, entries.position, entries.steps],
        )
        self._batches.append(entries)

    def cover(self) -> Cover:
        """Of all patches added. A counting sort: O(entry + site) time."""
        entries, site_count, order = _Entries.together(self._batches), len(self.flow.position), self.flow.order
        self._batches, self._tables = [], None
        start = np.append(np.zeros(1, np.int32), np.cumsum(np.bincount(entries.site, minlength=site_count)))
        start = start.astype(np.int32)
        first = np.append(np.zeros(1, np.int32), np.cumsum(entries.count, dtype=np.int32))
        steps = (np.arange(order) + (order - 1) // 2) % order - (order - 1) // 2
        total = int(start[-1])
        patch, position = np.empty(total, np.int32), np.empty((total, 2), np.float32)
        turn = np.empty(total if order > 1 else 0, np.float32)
        launch(
            group_cover,
            1,
            inputs=[
                *(first, entries.site, entries.position, entries.steps),
                (steps * (2 * np.pi / order)).astype(np.float32),
            ],
            outputs=[start[:-1].copy(), patch, position, turn],
        )
        return start, patch, position, turn if order > 1 else None


@dataclass(frozen=True, eq=False)
class _Entries:
    """Sites of some patches, patch after patch: how many in each; site, position and n-ths of a turn of every one."""

    count: Int32[np.ndarray, "patch"]
    site: Int32[np.ndarray, "entry"]
    position: Float32[np.ndarray, "entry 2"]
    steps: Int8[np.ndarray, "turned"]

    @classmethod
    def empty(cls, count: Int32[np.ndarray, "patch"], *, steps: bool) -> "_Entries":
        total = int(count.sum())
        turned = total if steps else 0
        return cls(count, np.empty(total, np.int32), np.empty((total, 2), np.float32), np.empty(turned, np.int8))

    @classmethod
    def together(cls, parts: list["_Entries"]) -> "_Entries":
        """One after the other."""
        parts = [*parts, cls.empty(np.zeros(0, np.int32), steps=False)]
        return cls(
            *(np.concatenate([getattr(p, name) for p in parts]) for name in ("count", "site", "position", "steps"))
        )


class _Tables:
    """Room for the kernel to work in: for each patch of a batch so many sites, twice the faces, hash tables of both."""

    def __init__(self, patches: int, room: int) -> None:
        faces, sites = (patches, 2 * room), (patches, room)
        self.patches, self.room = patches, room
        self.scratch = [
            *(np.empty(_slots(faces), np.int32), np.empty(_slots(sites), np.int32)),
            *(np.empty(faces, np.int32), np.empty(faces, np.int32), np.empty(faces, np.float32)),
            *(np.empty((*faces, 2), np.float32), np.empty((*faces, 2), np.float32)),
        ]
        self.found = [
            *(np.empty(sites, np.int32), np.empty(sites, np.int32)),
            *(np.empty((*sites, 2), np.float32), np.empty((*sites, 2), np.float32)),
        ]


def _slots(shape: tuple[int, int]) -> tuple[int, int]:
    """Of hash tables at most half full: a power of two."""
    return shape[0], 1 << (2 * shape[1] - 1).bit_length()
