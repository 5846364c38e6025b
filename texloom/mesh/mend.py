"""Mending a mesh without guessing: every mend is counted and said, what cannot be mended is refused."""

from dataclasses import dataclass, field

import numpy as np
from jaxtyping import Float, Int, Int32

from texloom.errors import MeshError
from texloom.mesh.degenerate import flatten_away, has_no_area, needles
from texloom.mesh.mesh import Mesh
from texloom.mesh.orient import orient
from texloom.mesh.split import split
from texloom.mesh.weld import weld


@dataclass(frozen=True, eq=False)
class Mended:
    """A manifold, consistently oriented mesh, and where each of its faces and corners came from."""

    mesh: Mesh
    corner_origin: Int32[np.ndarray, "face 3"]  # vertex given, at each corner
    face_origin: Int32[np.ndarray, "face"]  # face given
    corner_given: Int32[np.ndarray, "face 3"]  # corner given (3 · face + corner), so that values of corners survive
    mends: tuple[str, ...]  # one line for each kind of mend, with its count


@dataclass
class _Draft:
    """Faces on their way: each corner keeps the given corner it came from."""

    vertices: np.ndarray
    given: np.ndarray  # faces as they were given
    faces: np.ndarray
    corners: np.ndarray  # given corner (3 · face + corner) at each corner
    origins: np.ndarray  # given face
    mends: list[str]
    mesh: Mesh = field(init=False)  # over ``faces``, made anew when they change: what it knows serves every step

    def __post_init__(self) -> None:
        self.mesh = Mesh(self.vertices, self.faces)

    def change(self, faces: np.ndarray) -> None:
        """Take other faces."""
        self.faces = faces
        self.mesh = Mesh(self.vertices, faces)

    def keep(self, kept: np.ndarray) -> int:
        """Keep some faces; returns how many were dropped."""
        dropped = len(kept) - int(kept.sum())
        if dropped:
            self.corners, self.origins = self.corners[kept], self.origins[kept]
            self.change(self.faces[kept])
        return dropped

    def say(self, count: int, did: str, what: str, how: str = "") -> None:
        """Note a mend that happened ``count`` times."""
        if count:
            self.mends.append(f"{did} {counted(count, what)}{how}")


def mend(vertices: Float[np.ndarray, "vertex 3"], faces: Int[np.ndarray, "face 3"]) -> Mended:
    """The same surface, manifold: duplicate vertices welded, faces without area and duplicate faces gone, neighbours
    turned the same way, crowded edges and vertices parted, one-sided parts cut open, unused vertices dropped.

    Vertices and faces that remain keep their order. About 1 µs a face.

    Raises: MeshError, if there is nothing to texture or a number cannot be meant.
    """
    check(vertices, faces)
    draft = _draft(vertices, faces)
    _weld(draft)
    draft.say(_drop_folded(draft), "dropped", "degenerate face")
    draft.say(_drop_duplicates(draft), "dropped", "duplicate face")
    _orient(draft)
    _flatten(draft)
    return _split(draft)


def check(vertices: Float[np.ndarray, "vertex 3"], faces: Int[np.ndarray, "face 3"]) -> None:
    """Refuse what cannot be mended.

    Raises: MeshError, saying which vertex or face is wrong.
    """
    if len(vertices) == 0:
        raise MeshError("the mesh is empty: it has no vertices")
    if len(faces) == 0:
        raise MeshError(f"the mesh has {len(vertices)} vertices but no faces: texture needs a surface")
    outside = (faces < 0) | (faces >= len(vertices))
    if outside.any():
        face, corner = (int(i) for i in np.argwhere(outside)[0])
        raise MeshError(
            f"face {face} (counted from 0) names vertex {int(faces[face, corner])} (counted from 0), "
            f"but the mesh has {counted(len(vertices), 'vertex')}"
        )
    if not np.isfinite(vertices).all():
        finite = np.isfinite(vertices).all(axis=1)
        vertex = int(np.argmin(finite))
        position = ", ".join(f"{value:g}" for value in vertices[vertex])
        raise MeshError(
            f"vertex {vertex} (counted from 0) is at ({position}); "
            f"{counted(int((~finite).sum()), 'position')} must be made finite"
        )


def _draft(vertices: np.ndarray, faces: np.ndarray) -> _Draft:
    count = len(faces)
    given = np.array(faces, np.int32)
    return _Draft(
        np.array(vertices, np.float64, order="C"),
        given,
        given,
        np.arange(3 * count, dtype=np.int32).reshape(count, 3),
        np.arange(count, dtype=np.int32),
        [],
    )


def _weld(draft: _Draft) -> None:
    lowest = weld(draft.vertices, draft.faces)
    used = np.zeros(len(draft.vertices), bool)
    used[draft.faces] = True
    welded = int((used & (lowest != np.arange(len(lowest)))).sum())
    unused = int((~used).sum())
    if welded:
        draft.change(lowest[draft.faces])
    draft.say(welded, "welded", "duplicate vertex")
    draft.say(unused, "dropped", "unreferenced vertex")


def _drop_folded(draft: _Draft) -> int:
    """Drop faces that name a vertex twice."""
    a, b, c = draft.faces.T
    return draft.keep((a != b) & (b != c) & (c != a))


def _drop_duplicates(draft: _Draft) -> int:
    """Keep the first of the faces over the same three vertices, whichever way round they run."""
    a, b, c = (draft.mesh.twins.reshape(-1, 3) // 3).T  # the face across each side
    if draft.mesh.agrees and not (((a == b) | (a == c)) & (a >= 0) | (b == c) & (b >= 0)).any():
        return 0  # nor do any two share all three sides
    ordered = np.sort(draft.faces, axis=1)
    order = np.lexsort(ordered.T)
    repeats = np.zeros(len(ordered), bool)
    repeats[order[1:]] = (ordered[order[1:]] == ordered[order[:-1]]).all(axis=1)
    return draft.keep(~repeats)


def _orient(draft: _Draft) -> None:
    flip = orient(draft.mesh)
    if not flip.any():
        return
    draft.corners[flip] = draft.corners[flip][:, [0, 2, 1]]
    draft.change(np.where(flip[:, None], draft.faces[:, [0, 2, 1]], draft.faces))
    draft.say(int(flip.sum()), "turned over", "face")


def _flatten(draft: _Draft) -> None:
    """Take faces without area out of the surface without opening it."""
    flat = has_no_area(draft.mesh)
    if flat.all():
        raise MeshError(f"all {len(draft.given)} faces are degenerate (they have no area): there is nothing to texture")
    if not flat.any():
        return
    faces = draft.faces.copy()
    for lower, higher in needles(draft.vertices, faces):
        faces[faces == higher] = lower
    draft.change(faces)
    _drop_folded(draft)
    _drop_duplicates(draft)
    faces = draft.faces.copy()
    kept = flatten_away(draft.vertices, faces, draft.corners, draft.origins)
    draft.change(faces)
    draft.keep(kept)
    draft.say(int(flat.sum()), "removed", "face", " without area")


def _split(draft: _Draft) -> Mended:
    parted = split(draft.mesh)
    draft.say(parted.cuts, "cut one-sided (non-orientable) parts open along", "edge")
    draft.say(parted.edges, "split", "non-manifold edge")
    draft.say(parted.vertices, "split", "non-manifold vertex")
    mesh = draft.mesh
    if len(parted.origin) != len(mesh.vertices) or not np.array_equal(parted.faces, mesh.faces):
        mesh = Mesh(draft.vertices[parted.origin], parted.faces)
    return Mended(mesh, draft.given.reshape(-1)[draft.corners], draft.origins, draft.corners, tuple(draft.mends))


def counted(count: int, what: str) -> str:
    """``count`` things, in the plural unless one."""
    if count != 1:
        what = what[:-2] + "ices" if what.endswith("vertex") else what + "s"
    return f"{count} {what}"
