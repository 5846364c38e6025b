"""What can be said of a mesh by counting."""

from dataclasses import dataclass

import numpy as np

from texloom.mesh.mesh import Mesh
from texloom.mesh.split import split

_SLIVER = 0.01  # height over the longest side


@dataclass(frozen=True)
class Diagnosis:
    """Counts and sizes of a mesh; lengths are world units."""

    vertices: int
    edges: int
    faces: int
    parts: int  # connected
    boundary_edges: int
    boundary_loops: int
    euler: int  # vertices - edges + faces
    genus: int | None  # handles of all parts together; None where the mesh is not manifold
    closed: bool
    oriented: bool  # neighbours run opposite ways along every edge
    manifold: bool
    crowded_edges: int  # with three faces or more
    bowtie_vertices: int  # where several fans of faces meet
    slivers: int  # faces whose height is below 1 % of their longest side
    size: tuple[float, float, float]  # of the bounding box
    area: float
    edge_length_median: float
    edge_length_longest: float


def diagnose(mesh: Mesh) -> Diagnosis:
    """Count everything. Vertices no face uses count as vertices, but are no part."""
    counts = np.bincount(mesh.halfedge_edges, minlength=len(mesh.edges))
    used = np.zeros(len(mesh.vertices), bool)
    used[mesh.faces] = True
    parts = len(np.unique(mesh.vertex_parts[used]))
    crowded, bowties = int((counts > 2).sum()), _bowties(mesh)
    single = counts == 1
    loops = _loops(mesh, mesh.edges[single])
    oriented = bool(((mesh.twins >= 0) | (counts != 2)[mesh.halfedge_edges]).all())
    manifold = crowded == 0 and bowties == 0
    euler = int(used.sum()) - len(mesh.edges) + len(mesh.faces)
    return Diagnosis(
        vertices=len(mesh.vertices),
        edges=len(mesh.edges),
        faces=len(mesh.faces),
        parts=parts,
        boundary_edges=int(single.sum()),
        boundary_loops=loops,
        euler=euler,
        genus=(2 * parts - loops - euler) // 2 if manifold and oriented else None,
        closed=not single.any() and manifold,
        oriented=oriented,
        manifold=manifold,
        crowded_edges=crowded,
        bowtie_vertices=bowties,
        slivers=_slivers(mesh),
        size=(
            float(np.ptp(mesh.vertices[:, 0])),
            float(np.ptp(mesh.vertices[:, 1])),
            float(np.ptp(mesh.vertices[:, 2])),
        ),
        area=float(mesh.face_areas.sum()),
        edge_length_median=float(np.median(mesh.edge_lengths)),
        edge_length_longest=float(mesh.edge_lengths.max()),
    )


def _loops(mesh: Mesh, boundary: np.ndarray) -> int:
    """Closed lines the boundary edges make."""
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    if len(boundary) == 0:
        return 0
    ends, numbers = np.unique(boundary, return_inverse=True)
    rows, columns = numbers.reshape(-1, 2).T
    graph = coo_array((np.ones(len(rows), bool), (rows, columns)), shape=(len(ends), len(ends)))
    return int(connected_components(graph, directed=False)[0])


def _bowties(mesh: Mesh) -> int:
    """Vertices whose faces hang together in several fans, though no edge there is crowded."""
    return split(mesh).vertices


def _slivers(mesh: Mesh) -> int:
    """Faces whose height is next to nothing against their longest side."""
    longest = mesh.edge_lengths[mesh.halfedge_edges].reshape(-1, 3).max(axis=1)
    return int((2 * mesh.face_areas < _SLIVER * longest**2).sum())
