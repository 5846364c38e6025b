"""The texture as it grows."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float32, Int32

from texloom.arrays import Image
from texloom.domain.domain import Domain
from texloom.domain.neighbourhoods import Beside
from texloom.sources import SourceMap
from texloom.synthesis.gaps import fill_gaps


@dataclass(frozen=True, eq=False)
class Canvas:
    """What each site shows, from where in the exemplar, how turned, and the patch it came with (-1: none yet).

    The arrays are written in place while the texture grows; ``turn`` is radians against the site's frame.
    """

    position: Float32[np.ndarray, "site 2"]
    colour: Float32[np.ndarray, "site channel"]
    label: Int32[np.ndarray, "site"]
    turn: Float32[np.ndarray, "site"]

    @staticmethod
    def empty(count: int, channels: int) -> "Canvas":
        """No site coloured."""
        return Canvas(
            np.zeros((count, 2), np.float32),
            np.zeros((count, channels), np.float32),
            np.full(count, -1, np.int32),
            np.zeros(count, np.float32),
        )

    def bare(self, sites: Bool[np.ndarray, "site"] | None = None) -> Bool[np.ndarray, "site"]:
        """The sites (None: of all) that show nothing yet."""
        bare = self.label < 0
        return bare if sites is None else bare & sites

    @property
    def next_label(self) -> int:
        """The first label that no site has, nor a lower one without."""
        return int(self.label.max(initial=-1)) + 1

    def close(
        self,
        domain: Domain,
        image: Image,
        usable: Bool[np.ndarray, "row column"] | None = None,
        sites: Bool[np.ndarray, "site"] | None = None,
    ) -> None:
        """Continue the texture over ``sites`` (None: all) that no patch reached, where it is ``usable`` (None: all)."""
        bare = self.bare(sites)
        fill_gaps(domain, self.label >= 0, self.position, self.turn, image.shape[:2], sites)
        texel = np.rint(self.position[bare]).astype(np.int32)
        if usable is not None and not usable[texel[:, 0], texel[:, 1]].all():
            texel = nearest_usable(texel, usable)
            self.position[bare] = texel
        self.colour[bare] = image[texel[:, 0], texel[:, 1]]
        self.label[bare] = self.next_label  # a patch of its own, so that correction visits its border

    def continued(
        self, beside: Beside, image: Image, scale: float, usable: Bool[np.ndarray, "row column"] | None = None
    ) -> "Canvas":
        """What this canvas shows, continued to the places beside its sites, in an image ``scale`` times as large.

        Nothing leaves the image, or what of it is ``usable`` (None: all).
        """
        turn = self.turn[beside.site]
        row, column = beside.offset.T
        cosine, sine = np.cos(turn), np.sin(turn)
        way = np.stack([cosine * row + sine * column, cosine * column - sine * row], axis=1)
        canvas = Canvas.empty(len(turn), image.shape[2])
        canvas.position[:] = _readable(np.float32(scale) * (self.position[beside.site] + way), image.shape[:2], usable)
        canvas.turn[:] = turn + beside.turn
        canvas.label[:] = self.label[beside.site]
        canvas.colour[:] = _between(image, canvas.position)
        return canvas

    def look(self, image: Image, sites: Int32[np.ndarray, "n"]) -> None:
        """Give sites the colours of the places that they show."""
        self.colour[sites] = _between(image, self.position[sites])

    def sources(self) -> SourceMap:
        """One source a site."""
        turn = self.turn[:, None] if self.turn.any() else None
        return SourceMap(self.position[:, None], np.ones((len(self.position), 1), np.float32), turn)


def _readable(
    position: Float32[np.ndarray, "n 2"], shape: tuple[int, int], usable: Bool[np.ndarray, "row column"] | None
) -> Float32[np.ndarray, "n 2"]:
    """The same places, inside the image; those that would read a texel not ``usable`` move to the nearest that is."""
    position = np.clip(position, 0, np.array(shape, np.float32) - 1)
    if usable is None:
        return position
    low, high = np.floor(position).astype(np.int32), np.ceil(position).astype(np.int32)
    corners = [usable[row[:, 0], column[:, 1]] for row in (low, high) for column in (low, high)]
    wrong = ~np.logical_and.reduce(corners)
    position[wrong] = nearest_usable(np.rint(position[wrong]).astype(np.int32), usable)
    return position


def _between(image: Image, position: Float32[np.ndarray, "n 2"]) -> Float32[np.ndarray, "n channel"]:
    """The image between its texels, clamped at its border."""
    from scipy.ndimage import map_coordinates

    channels = [map_coordinates(channel, position.T, order=1, mode="nearest") for channel in np.moveaxis(image, 2, 0)]
    return np.stack(channels, axis=1)


def nearest_usable(texel: Int32[np.ndarray, "n 2"], usable: Bool[np.ndarray, "row column"]) -> Int32[np.ndarray, "n 2"]:
    """The usable texel nearest to each."""
    from scipy.ndimage import distance_transform_edt

    row, column = np.asarray(distance_transform_edt(~usable, return_distances=False, return_indices=True))
    return np.stack([axis[texel[:, 0], texel[:, 1]] for axis in (row, column)], 1).astype(np.int32)
