"""Sharp corners of the mesh's boundary: points there stay, or triangulations would cut them off."""

import numpy as np

from texloom.points.ground import Ground
from texloom.points.places import Places
from texloom.points.tiling import norms

_SHARP = 0.77  # cosine of 40 degrees, that a boundary turns at a corner
_ALONE = 1.0  # spacings to the next corner: the teeth of a ragged boundary have none
_FEW = 0.25  # of all points; with more corners than that, none is kept


def corners(ground: Ground, count: int) -> Places:
    """Points to begin with in the corners, few for ``count`` and far from each other."""
    from scipy.spatial import KDTree

    _, leading = ground.rim
    halfedges = np.flatnonzero(leading >= 0)
    tails = ground.mesh.faces.reshape(-1)
    along = ground.vertices[np.roll(ground.mesh.faces, -1, axis=1).reshape(-1)] - ground.vertices[tails]
    along /= np.maximum(norms(along), 1e-300)[:, None]
    turn = np.einsum("hx,hx->h", along[halfedges], along[leading[halfedges]])
    sharp = halfedges[turn < _SHARP]
    if len(sharp):
        at = ground.vertices[tails[sharp]]
        apart = KDTree(at).query(at, k=2)[0][:, 1]
        sharp = sharp[apart > _ALONE * ground.spacing(count) * ground.scale[tails[sharp]]]
    if len(sharp) > _FEW * count:
        sharp = sharp[:0]
    face, side = np.divmod(sharp.astype(np.int32), 3)
    barycentric = np.eye(3)[side]
    vertex = tails[sharp]
    normal = ground.normals(face, barycentric)
    return Places(ground.vertices[vertex], ground.scale[vertex], normal, face, barycentric, side)
