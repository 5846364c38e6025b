"""The windows of an exemplar in a kd-tree of their principal components, for kernels that search as they go."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float32, Int32, UInt8

from texloom.arrays import Image, fours
from texloom.exemplar.blas import over_blocks
from texloom.exemplar.pca import fit
from texloom.search.tree import KdTree

_FITTED = 2048  # windows whose axes are found
_BLOCK = 1024  # windows gathered at once


@dataclass(frozen=True, eq=False)
class WindowTree:
    """Windows of ``sample`` texels each around their ``centre``, compared by ``component`` principal components."""

    centre: Int32[np.ndarray, "window 2"]
    mean: Float32[np.ndarray, "sample channel"]
    axes: Float32[np.ndarray, "sample channel component"]  # orthonormal over samples and channels
    tree: KdTree

    @staticmethod
    def of(
        image: Image, usable: UInt8[np.ndarray, "row column"], steps: Int32[np.ndarray, "sample 2"], dimensions: int
    ) -> "WindowTree":
        """The windows around all usable texels, read at ``steps`` from them. The components are a multiple of four."""
        columns, channels = image.shape[1:]
        centre = np.ascontiguousarray(np.argwhere(usable), np.int32)
        texels, middle = image.reshape(-1, channels), centre @ [columns, 1]
        step = steps @ [columns, 1]
        fitted = np.arange(min(len(centre), _FITTED)) * len(centre) // min(len(centre), _FITTED)
        projection = fit(texels[middle[fitted][:, None] + step].reshape(len(fitted), -1), dimensions)
        points = np.empty((len(centre), projection.axes.shape[1]), np.float32)

        def project(first: int, last: int) -> None:
            windows = texels[middle[first:last, None] + step].reshape(last - first, -1)
            points[first:last] = (windows - projection.mean) @ projection.axes

        over_blocks(project, len(centre), _BLOCK)
        absent = (0, -points.shape[1] % 4)
        axes = np.pad(projection.axes, ((0, 0), absent))
        return WindowTree(
            centre,
            projection.mean.reshape(len(steps), channels),
            axes.reshape(len(steps), channels, -1),
            KdTree.of(points),
        )

    @property
    def arrays(self) -> dict[str, np.ndarray]:
        """As kernels take it."""
        names = ("points", "index", "low", "high", "first", "last")
        own = {"axes": fours(self.axes), "mean": fours(self.mean), "centre": self.centre}
        return own | dict(zip(names, self.tree.arrays, strict=True))
