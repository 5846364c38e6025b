"""A direction field along the principal curvatures of the surface."""

import numpy as np
from jaxtyping import Float64

from texloom.errors import FieldError
from texloom.field.direction import DirectionField, check_order, tangent_part
from texloom.field.frames import VertexFrames
from texloom.field.smooth import near
from texloom.mesh.mesh import Mesh

_REACH = 0.02  # of the diagonal: where the surface is fully anisotropic, smoothing reaches this far,
_LEAST_REACH = 2.0  # and at least so many edges
_ISOTROPIC = 0.1  # anisotropy up to which a direction is taken for noise
_BENT = 0.05  # over the diagonal: a surface bent much less than this counts as flat


def along_curvature(mesh: Mesh, order: int) -> DirectionField:
    """The field along the lines of least curvature: lengthwise on a limb, with its crosses around it.

    Where the curvature has no direction (plane, sphere, noise) the field is smooth instead: each vertex pulls with the
    square of its anisotropy |k1 − k2| / (|k1| + |k2|). Curvatures are libigl's, fitted to a quadric over five rings.

    Raises: FieldError, unless the symmetry is 2 or 4: curvature cannot tell forth from back, nor six ways apart.
    """
    check_order(order)
    if order not in (2, 4):
        raise FieldError(f"curvature gives a field of symmetry 2 or 4, not {order}: choose one of them, or smooth")
    direction, anisotropy = _least_curvature(mesh)
    frames = VertexFrames(mesh, order)
    power = frames.powers(np.arange(len(mesh.vertices)), direction)
    reach = max(_REACH * mesh.diagonal, _LEAST_REACH * float(mesh.edge_lengths.mean()))
    return near(mesh, order, power=power, weight=np.where(anisotropy > _ISOTROPIC, anisotropy / reach, 0.0) ** 2)


def _least_curvature(mesh: Mesh) -> tuple[Float64[np.ndarray, "vertex 3"], Float64[np.ndarray, "vertex"]]:
    """Tangent of least absolute curvature at every vertex, and how much it stands out, in [0, 1]."""
    import igl

    # Scaled and centred: the fit takes tiny or distant meshes for degenerate ones
    centred = (mesh.vertices - mesh.vertices.mean(axis=0)) / max(mesh.diagonal, 1e-300)
    found = igl.principal_curvature(centred, mesh.faces.astype(np.int64))
    axis_1, axis_2, bend_1, bend_2 = (np.asarray(part) for part in found[:4])
    flatter = np.where((np.abs(bend_1) < np.abs(bend_2))[:, None], axis_1, axis_2)
    tangent = tangent_part(flatter, mesh.vertex_normals)
    spread = np.abs(bend_1 - bend_2) / (np.abs(bend_1) + np.abs(bend_2) + _BENT)
    usable = np.isfinite(spread) & np.isfinite(tangent).all(axis=1) & tangent.any(axis=1)
    return np.where(usable[:, None], tangent, 0.0), np.where(usable, np.clip(spread, 0.0, 1.0), 0.0)
