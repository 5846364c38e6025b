"""Blending over the edges of faces that each show their own piece of a sample (Magda & Kriegman 2003, section 3.3).

``coordinates`` are [row, column] exemplar positions of every face's corners: affine inside the face, and close to a
similarity that keeps orientation. They and the mesh are all there is to know.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from jaxtyping import Bool, Complex128, Float, Float32, Int, Int32, Shaped

from texloom.arrays import Image
from texloom.errors import ParameterError
from texloom.kernels import blending as kernels
from texloom.kernels.launch import launch
from texloom.mesh.mesh import Mesh
from texloom.sources import SourceMap

REACH = 0.5
"""Share of a face's height, from an edge towards the opposite corner, over which the neighbour's map fades out."""

THRESHOLD = 150.0
"""Φ above which an edge is blended: differences of 255 times pixels, so 7.5 of 255 along an edge 20 pixels long.

Chosen by eye, on pictures as large as the viewer sees: at 300 some edges still show, below 150 none did.
"""


@dataclass(frozen=True, eq=False)
class Neighbours:
    """The maps of the neighbours across the three edges of each face; number k lies opposite to corner k.

    ``positions[f, k, c]`` is where corner ``c`` of face ``f`` lies in the map of neighbour ``k`` laid on beyond their
    edge, and ``turn[f, k]`` how that map is turned against the own, in radians as a source's turn. Where there is no
    neighbour both are the face's own.
    """

    positions: Float32[np.ndarray, "face across corner 2"]
    turn: Float32[np.ndarray, "face across"]
    there: Bool[np.ndarray, "face across"]


def neighbours(mesh: Mesh, coordinates: Float[np.ndarray, "face 3 2"]) -> Neighbours:
    """Lay every neighbour's map on across its edge, by the similarity that takes the own picture of the edge to its.

    Neighbour and face then meet along the edge texel by texel; it is the face unfolded beside its neighbour. O(face).
    """
    own = _complex(coordinates)
    at_tails, at_heads = own.reshape(-1), own.take([1, 2, 0], axis=1).reshape(-1)
    positions, there = np.repeat(own[:, None], 3, axis=1), np.zeros(own.shape, bool)
    turn = np.zeros(own.shape, np.float32)
    for k in range(3):
        tail, head = (k + 1) % 3, (k + 2) % 3
        twin = mesh.twins[tail::3]
        edge = own[:, head] - own[:, tail]
        face = np.flatnonzero((twin >= 0) & (edge != 0))
        at_tail, at_head = at_heads[twin[face]], at_tails[twin[face]]
        ratio = (at_head - at_tail) / edge[face]
        positions[face, k, tail], positions[face, k, head] = at_tail, at_head
        positions[face, k, k] = at_tail + ratio * (own[face, k] - own[face, tail])
        turn[face, k] = np.angle(ratio)
        there[face, k] = True
    return Neighbours(_pairs(positions), turn, there)


@dataclass(frozen=True, kw_only=True)
class Viewer:
    """From where a blend is judged. The default is far enough to see the mesh's bounding sphere whole."""

    width: int = 1024  # pixels across the field of view
    field_of_view: float = 45.0  # degrees
    distance: float | None = None  # from the edges, world units; None: the sphere just fills the field of view

    def __post_init__(self) -> None:
        if self.width < 1 or not 0 < self.field_of_view < 180 or not (self.distance is None or self.distance > 0):
            raise ParameterError(
                f"a viewer {self.distance} away with {self.field_of_view:g} degrees across {self.width} pixels: "
                "give a distance above 0, an angle between 0 and 180 and 1 pixel or more"
            )

    def distance_to(self, mesh: Mesh) -> float:
        """World units from the viewer to the edges."""
        if self.distance is not None:
            return self.distance
        along = np.ascontiguousarray(mesh.vertices.T)
        centre = (along.min(axis=1, keepdims=True) + along.max(axis=1, keepdims=True)) / 2
        radius = float(np.linalg.norm(along - centre, axis=0).max())
        return radius / np.sin(np.radians(self.field_of_view) / 2)

    def pixels(self, mesh: Mesh) -> float:
        """Pixels of a world unit across the line of sight: λ / ‖v − m‖, with λ = w / φ (φ in radians)."""
        return self.width / np.radians(self.field_of_view) / self.distance_to(mesh)


@dataclass(frozen=True, eq=False)
class EdgeErrors:
    """How much the two sides of every inner edge differ along it, of 255, and the edge's length in world units.

    ``halfedge`` is the lower of the two under an edge, ``mean`` the paper's E_t (mean Euclidean distance of colours),
    ``root`` the root of the mean square.
    """

    mesh: Mesh
    halfedge: Int32[np.ndarray, "edge"]
    mean: Float32[np.ndarray, "edge"]
    root: Float32[np.ndarray, "edge"]

    @cached_property
    def length(self) -> Float32[np.ndarray, "edge"]:
        """World length."""
        tails, heads = self.mesh.faces, self.mesh.faces.take([1, 2, 0], axis=1)
        along = np.ascontiguousarray(self.mesh.vertices.T)
        tail, head = (along.take(ends.reshape(-1)[self.halfedge], axis=1) for ends in (tails, heads))
        return np.linalg.norm(head - tail, axis=0).astype(np.float32)

    def visibility(self, viewer: Viewer | None = None) -> Float32[np.ndarray, "edge"]:
        """Φ = λ E_t d / ‖v − m‖ (eq. 4): difference of 255 times length in pixels."""
        return self.mean * self.length * np.float32((viewer or Viewer()).pixels(self.mesh))

    def at_faces(self, values: Shaped[np.ndarray, "edge"]) -> Shaped[np.ndarray, "face across"]:
        """A value of each edge at the corners opposite to it; 0 or False opposite to a boundary."""
        result = np.zeros(self.mesh.faces.size, values.dtype)
        result[_opposite(self.halfedge)] = values
        result[_opposite(self.mesh.twins[self.halfedge])] = values
        return result.reshape(-1, 3)

    def blended(self, viewer: Viewer | None = None, *, threshold: float = THRESHOLD) -> Bool[np.ndarray, "edge"]:
        """Edges that show: Φ above the threshold, in differences of 255 times pixels."""
        return self.visibility(viewer) > threshold


def edge_errors(mesh: Mesh, coordinates: Float[np.ndarray, "face 3 2"], image: Image) -> EdgeErrors:
    """Compare the two maps along every inner edge, bilinearly, at points about a texel apart.

    ``image`` is what differences are measured in, channels in [0, 1]: the sample as matching sees it
    (``texloom.exemplar.features.match_image``).
    """
    twins = mesh.twins
    halfedge = np.flatnonzero(np.arange(len(twins), dtype=np.int32) < twins).astype(np.int32)
    mean, root = np.empty(len(halfedge), np.float32), np.empty(len(halfedge), np.float32)
    flat = np.ascontiguousarray(image, np.float32).reshape(-1)
    inputs = [flat, *image.shape, _floats(coordinates), halfedge, twins[halfedge]]
    launch(kernels.edge_differences, len(halfedge), inputs=inputs, outputs=[mean, root])
    return EdgeErrors(mesh, halfedge, mean * np.float32(255), root * np.float32(255))


@dataclass(frozen=True, eq=False)
class Blend:
    """Faces in their own maps and, over the edges chosen, in their neighbours'.

    Departure: the paper's weight depends on the distance from one edge alone, so that on an edge the other two
    neighbours still count, and the two sides differ. Ours is 0 on the other edges: the picture is continuous over
    every blended edge, and breaks at vertices only.
    """

    coordinates: Float32[np.ndarray, "face 3 2"]
    neighbours: Neighbours
    edges: Bool[np.ndarray, "face across"]  # whether the edge opposite to each corner is blended
    reach: float = REACH

    @property
    def count(self) -> int:
        """Number of blended edges."""
        return int(self.edges.sum()) // 2

    def sources(self, face: Int[np.ndarray, "point"], barycentric: Float[np.ndarray, "point 3"]) -> SourceMap:
        """What points of faces show, each a site in its face's frame: the own map and up to three neighbours."""
        count = len(face)
        position, turn = np.empty((count, 4, 2), np.float32), np.empty((count, 4), np.float32)
        weight = np.empty((count, 4), np.float32)
        points = [np.ascontiguousarray(face, np.int32), _floats(barycentric)]
        maps = [self.coordinates, self.neighbours.positions, self.neighbours.turn, self.edges.view(np.uint8)]
        outputs = [position, weight, turn]
        launch(kernels.blend_points, count, inputs=[*points, *maps, self.reach], outputs=outputs)
        return SourceMap(position, weight, turn)


def blend(
    mesh: Mesh, coordinates: Float[np.ndarray, "face 3 2"], edges: Bool[np.ndarray, "face across"] | None = None
) -> Blend:
    """Faces blended over ``edges``, given opposite to each corner (``EdgeErrors.at_faces``); None: over none."""
    beside = neighbours(mesh, coordinates)
    chosen = np.zeros(mesh.faces.shape, bool) if edges is None else edges & beside.there
    return Blend(_floats(coordinates), beside, np.ascontiguousarray(chosen))


def _opposite(halfedge: Int32[np.ndarray, "edge"]) -> Int32[np.ndarray, "edge"]:
    """The corner, counted through all faces, opposite to a halfedge's edge."""
    return halfedge - halfedge % 3 + (halfedge + 2) % 3


def _complex(positions: Float[np.ndarray, "face 3 2"]) -> Complex128[np.ndarray, "face 3"]:
    """column + 1j row."""
    return positions[..., 1] + 1j * positions[..., 0].astype(np.float64)


def _pairs(places: Complex128[np.ndarray, "*shape"]) -> Float32[np.ndarray, "*shape 2"]:
    """[row, column]."""
    pairs = np.empty((*places.shape, 2), np.float32)
    pairs[..., 0], pairs[..., 1] = np.imag(places), np.real(places)
    return pairs


def _floats(values: np.ndarray) -> Float32[np.ndarray, "..."]:
    return np.ascontiguousarray(values, np.float32)
