"""A sample's vocabulary of textons: learnt once, it textures any number of meshes (Magda & Kriegman 2003, section 3.1).

Each texel is labelled with the texton nearest to its surroundings. Strings of such labels are then compared in place of
texels.
"""

from dataclasses import dataclass
from functools import cached_property
from math import pi, sqrt

import numpy as np
from jaxtyping import Float32, Int32

from texloom.arrays import Image
from texloom.errors import ParameterError
from texloom.exemplar.blas import over_blocks
from texloom.exemplar.exemplar import Exemplar
from texloom.exemplar.features import match_image
from texloom.progress import Report, silent
from texloom.search.kmeans import Centres, settle, to_nearest
from texloom.search.texton_banks import Bank, FilterBank, WindowBank
from texloom.search.texton_features import ROWS, TextonFeatures

FEATURES = ("window", "filters")

_KEPT = 0.99  # of the texels keep their texton in the pass after which clustering stops, as in the paper's table 1
_MOST_ORIENTATIONS = 64
_PAIRED = 16  # textons compared with all others at once
_SHORT = 2**15 - 1  # so many labels are sorted sooner in 16 bits


@dataclass(frozen=True, kw_only=True)
class TextonSettings:
    """How textons are learnt.

    Raises: ParameterError, for a value out of its range.
    """

    count: int | None = None  # textons asked for; None: the square root of the number of usable texels
    width: int = 11  # texels a side of the window; the filters have their own
    features: str = "window"  # or "filters"
    orientations: int = 16  # turns of the surroundings that are labelled
    seed: int = 0

    def __post_init__(self) -> None:
        if self.count is not None and self.count < 1:
            raise ParameterError(f"{self.count} textons: give 1 or more")
        if self.features not in FEATURES:
            raise ParameterError(f"unknown features {self.features!r}: choose {' or '.join(FEATURES)}")
        if not 1 <= self.orientations <= _MOST_ORIENTATIONS:
            raise ParameterError(f"{self.orientations} orientations: give 1 to {_MOST_ORIENTATIONS}, such as 16")
        _ = self.bank

    @property
    def bank(self) -> Bank:
        """What is seen of a texel's surroundings."""
        return WindowBank(self.width) if self.features == "window" else FilterBank()


@dataclass(frozen=True, eq=False)
class Textons:
    """A sample and its vocabulary.

    ``labels[j]`` are those of the surroundings turned by 2πj/M, M the number of orientations: of the texels
    ``image[p + exp(2πi j/M) d]`` around ``p``, offsets being column + 1j · row. All share the textons of orientation 0,
    so there is one distance table. Masked texels have the label -1.
    """

    exemplar: Exemplar
    image: Image  # match_image(exemplar): what edges are compared by
    labels: Int32[np.ndarray, "orientation row column"]
    distance: Float32[np.ndarray, "texton texton"]  # squared difference of two textons
    settings: TextonSettings
    passes: int  # of k-means over all texels
    kept: float  # share of the texels that kept their texton in the last pass

    @cached_property
    def bucket_start(self) -> Int32[np.ndarray, "texton_plus_one"]:
        """Where in ``bucket`` the texels of each texton begin."""
        size = np.bincount(self.labels[0][self.labels[0] >= 0], minlength=self.count)
        return np.concatenate([[0], np.cumsum(size)]).astype(np.int32)

    @cached_property
    def bucket(self) -> Int32[np.ndarray, "texel"]:
        """Texels, as row · columns + column, by their texton of orientation 0; those of one texton in rising order."""
        label = self.labels[0].ravel()
        order = np.argsort(label if self.count > _SHORT else label.astype(np.int16), kind="stable")
        return order[np.count_nonzero(label < 0) :].astype(np.int32)

    @property
    def count(self) -> int:
        """Textons."""
        return len(self.distance)


def learn_textons(
    exemplar: Exemplar,
    *,
    count: int | None = None,
    width: int = 11,
    features: str = "window",
    orientations: int = 16,
    seed: int = 0,
    report: Report = silent,
) -> Textons:
    """Textons of a sample, the labels of its texels at each orientation, and the table of their distances.

    Fewer textons than asked for where fewer surroundings differ. ``report`` may stop the work between two passes.

    Raises: ParameterError, for a value out of its range.
    """
    settings = TextonSettings(count=count, width=width, features=features, orientations=orientations, seed=seed)
    report("textons", 0.0)
    image = match_image(exemplar)
    seen = TextonFeatures.of(image, settings.bank, exemplar.mask)
    vectors = seen.all(turn=0.0) if exemplar.mask is None else seen.all(turn=0.0)[exemplar.mask.ravel()]
    wanted = min(count or round(sqrt(len(vectors))), len(vectors))
    found = settle(vectors, wanted, kept=_KEPT, seed=seed, report=report)
    labels = np.full((orientations, *exemplar.shape), -1, np.int32)
    labels[0][exemplar.usable] = found.label
    for j in range(1, orientations):
        report("orientations", j / orientations)
        labels[j] = _labels(seen, found.centres, 2 * pi * j / orientations)
        labels[j][~exemplar.usable] = -1
    return Textons(exemplar, image, labels, _distances(found.centres), settings, found.passes, found.kept)


def _labels(seen: TextonFeatures, centres: Centres, turn: float) -> Int32[np.ndarray, "row column"]:
    """The texton nearest to the surroundings of each texel, turned."""
    describe, nearest = seen.turned(turn), to_nearest(centres)
    rows = over_blocks(lambda first, last: nearest(describe(first, last)), len(seen.image), ROWS)
    return np.concatenate(rows).reshape(seen.image.shape[:2])


def _distances(centres: Centres) -> Float32[np.ndarray, "texton texton"]:
    """Squared differences of all pairs: symmetric, and 0 on the diagonal."""
    from_each = over_blocks(
        lambda first, last: ((centres[first:last, None] - centres) ** 2).sum(axis=2), len(centres), _PAIRED
    )
    return np.concatenate(from_each)
