"""Points on the ground, as arrays that kernels read and write."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float64, Int32


@dataclass(frozen=True, eq=False)
class Places:
    """Points on the ground: where, how far apart they want to be (relative), and the boundary edge they keep to."""

    at: Float64[np.ndarray, "point 3"]  # from the ground's origin
    scale: Float64[np.ndarray, "point"]
    normal: Float64[np.ndarray, "point 3"]  # between those of the ground's vertices
    face: Int32[np.ndarray, "point"]
    barycentric: Float64[np.ndarray, "point 3"]
    side: Int32[np.ndarray, "point"]  # of the face, -1 inside

    @property
    def arrays(self) -> dict[str, np.ndarray]:
        """For the kernels, by the names above."""
        return vars(self)

    @classmethod
    def empty(cls, count: int) -> "Places":
        """Room for so many."""
        at, normal, barycentric = (np.empty((count, 3)) for _ in range(3))
        return cls(at, np.empty(count), normal, np.empty(count, np.int32), barycentric, np.empty(count, np.int32))

    def overwrite(self, which: np.ndarray | slice, others: "Places") -> None:
        """Put others where some of these are."""
        for name, array in self.arrays.items():
            array[which] = others.arrays[name]

    def __getitem__(self, chosen: np.ndarray) -> "Places":
        return Places(**{name: array[chosen] for name, array in self.arrays.items()})

    def joined(self, more: "Places") -> "Places":
        """These, then those."""
        return Places(**{name: np.concatenate([array, more.arrays[name]]) for name, array in self.arrays.items()})
