"""Image pyramids on a hierarchy of points: blur, down-sample, interpolate, up-sample; of any values, and of vectors.

Weights fall smoothly with the distance to 0 at a radius, w(x) = (1 - (x / r)²)², over points that are neighbours on
the surface. All operations are linear, keep constants and never leave the range of what they are given. Vectors are
carried from point to point in the surface, not averaged in space.
"""

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Float, Float64

from texloom.errors import ParameterError
from texloom.points.hierarchy import Hierarchy, Level
from texloom.points.transport import frames, to_complex, to_vectors, turns

if TYPE_CHECKING:
    from scipy.sparse import csr_array

_SHARE = 0.5  # of a value that its neighbours' take in one blur
_BLURS = 0.75  # for each time that the finer level has the points of the coarser
_LEAST = 1e-9  # weight of a face's corners beyond the radius: no place goes without


@dataclass(frozen=True, eq=False)
class Pyramid:
    """The operations, each a sparse matrix made at its first use."""

    hierarchy: Hierarchy
    radius: float = 1.75  # spacings

    def __post_init__(self) -> None:
        if not self.radius > 0:
            raise ParameterError(f"a radius of {self.radius:g} spacings reaches no neighbour: give one above 0")

    def blur(
        self, level: int, values: Float[np.ndarray, "point *channels"], *, times: int = 1
    ) -> Float64[np.ndarray, "point *channels"]:
        """C(v) + Σ wᵢ (C(vᵢ) − C(v)) over the neighbours vᵢ of each point, again and again."""
        return _repeated(self._blurs[level], _rows(values), times).reshape(values.shape)

    def down(self, level: int, values: Float[np.ndarray, "point *channels"]) -> Float64[np.ndarray, "coarse *channels"]:
        """From a level to the coarser one: blurred, then what belongs to finer points dropped."""
        return self.blur(level, values, times=self._blur_times(level))[: self._coarser(level)]

    def up(self, level: int, values: Float[np.ndarray, "point *channels"]) -> Float64[np.ndarray, "fine *channels"]:
        """From a level to the finer one: a weighted mean of what is near, at the points of both."""
        raised = self._raises[self._finer(level)] @ _rows(values)
        return raised.reshape(-1, *values.shape[1:])

    def blur_vectors(
        self, level: int, vectors: Float[np.ndarray, "point 3"], *, times: int = 1
    ) -> Float64[np.ndarray, "point 3"]:
        """``blur`` of tangent vectors (what stands out of the surface is left out)."""
        axes = self.axes[level]
        return to_vectors(_repeated(self._turned_blurs[level], to_complex(vectors, axes), times), axes)

    def down_vectors(self, level: int, vectors: Float[np.ndarray, "point 3"]) -> Float64[np.ndarray, "coarse 3"]:
        """``down`` of tangent vectors."""
        return self.blur_vectors(level, vectors, times=self._blur_times(level))[: self._coarser(level)]

    def up_vectors(self, level: int, vectors: Float[np.ndarray, "point 3"]) -> Float64[np.ndarray, "fine 3"]:
        """``up`` of tangent vectors."""
        above = self._finer(level)
        return to_vectors(self._turned_raises[above] @ to_complex(vectors, self.axes[level]), self.axes[above])

    @cached_property
    def axes(self) -> tuple[Float64[np.ndarray, "point 2 3"], ...]:
        """A frame at every point of every level, the same in all levels."""
        return tuple(frames(level.normal) for level in self.hierarchy.levels)

    @cached_property
    def _blurs(self) -> "list[csr_array]":
        return [_blur(level, self.radius) for level in self.hierarchy.levels]

    @cached_property
    def _raises(self) -> "list[csr_array]":
        """The matrix onto each level from the one below; onto the coarsest nothing."""
        levels = self.hierarchy.levels
        below = [_raise(coarse, fine, self.radius) for coarse, fine in zip(levels, levels[1:], strict=False)]
        return [_nothing(), *below]

    @cached_property
    def _turned_blurs(self) -> "list[csr_array]":
        return [_turned(blur, axes, axes) for blur, axes in zip(self._blurs, self.axes, strict=True)]

    @cached_property
    def _turned_raises(self) -> "list[csr_array]":
        matrices = zip(self._raises[1:], self.axes, self.axes[1:], strict=False)
        return [_nothing(), *(_turned(matrix, coarse, fine) for matrix, coarse, fine in matrices)]

    def _blur_times(self, level: int) -> int:
        """Blurs that take away what the coarser level cannot hold."""
        return max(1, round(_BLURS * self.hierarchy.levels[level].count / self._coarser(level)))

    def _coarser(self, level: int) -> int:
        """Points of the level below."""
        if not 0 < level < len(self.hierarchy.levels):
            raise ParameterError(f"nothing is coarser than level {level} of {len(self.hierarchy.levels)}")
        return self.hierarchy.levels[level - 1].count

    def _finer(self, level: int) -> int:
        """The number of the level above."""
        if not 0 <= level < len(self.hierarchy.levels) - 1:
            raise ParameterError(f"nothing is finer than level {level} of {len(self.hierarchy.levels)}")
        return level + 1


def _blur(level: Level, radius: float) -> "csr_array":
    """One blur: half of each value stays, the rest is shared among the neighbours by their weights."""
    from scipy.sparse import csr_array, diags_array

    tails, heads = np.concatenate([level.mesh.edges, level.mesh.edges[:, ::-1]]).T
    apart = np.tile(level.mesh.edge_lengths, 2)
    weight = np.maximum(_falling(apart / (radius * level.spacing * level.scale[tails])), _LEAST)
    total = np.bincount(tails, weights=weight, minlength=level.count)
    weight *= _SHARE / total[tails]
    near = csr_array((weight, (tails, heads)), shape=(level.count, level.count))
    return csr_array(near + diags_array(np.where(total > 0, 1 - _SHARE, 1.0)))


def _raise(coarse: Level, fine: Level, radius: float) -> "csr_array":
    """Weights of coarse points at the fine ones: those of the face a fine point lies in, and their neighbours."""
    from scipy.sparse import csr_array, eye_array

    assert fine.on_coarser is not None
    face, barycentric = fine.on_coarser
    rows, corners = np.repeat(np.arange(fine.count), 3), coarse.mesh.faces[face].reshape(-1)
    least = csr_array((_LEAST * (barycentric.reshape(-1) + _LEAST), (rows, corners)), shape=(fine.count, coarse.count))
    tails, heads = coarse.mesh.edges.T
    joined = csr_array((np.ones(len(tails)), (tails, heads)), shape=(coarse.count, coarse.count))
    near = csr_array(least @ (joined + joined.T + eye_array(coarse.count)))
    near.sort_indices()
    point = np.repeat(np.arange(fine.count), np.diff(near.indptr))
    apart = np.linalg.norm(fine.position[point] - coarse.position[near.indices], axis=1)
    near.data[:] = _falling(apart / (radius * coarse.spacing * fine.scale[point]))
    weights = csr_array(near + least)
    weights.eliminate_zeros()
    total = np.repeat(weights.sum(axis=1), np.diff(weights.indptr))
    weights.data /= total
    return weights


def _falling(share: Float[np.ndarray, "n"]) -> Float64[np.ndarray, "n"]:
    """1 at 0, smoothly to 0 at 1 and beyond."""
    return np.maximum(1 - share**2, 0.0) ** 2


def _turned(
    matrix: "csr_array", axes: Float[np.ndarray, "source 2 3"], onto: Float[np.ndarray, "target 2 3"]
) -> "csr_array":
    """The same weights for vectors in their frames."""
    from scipy.sparse import csr_array

    target = np.repeat(np.arange(len(onto)), np.diff(matrix.indptr))
    turned = matrix.data * turns(axes, onto, matrix.indices, target)
    return csr_array((turned, matrix.indices, matrix.indptr), shape=matrix.shape)


def _nothing() -> "csr_array":
    from scipy.sparse import csr_array

    return csr_array((0, 0))


def _rows(values: Float[np.ndarray, "point *channels"]) -> Float64[np.ndarray, "point channel"]:
    """One row a point, however many axes a value has."""
    return np.asarray(values, np.float64).reshape(len(values), -1)


def _repeated(matrix: "csr_array", values: np.ndarray, times: int) -> np.ndarray:
    for _ in range(times):
        values = matrix @ values
    return values
