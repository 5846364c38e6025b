"""Samples and faces to quilt, small and irregular."""

from functools import cache

import numpy as np
from numpy import ndarray

from tests.meshes import flat_square, sphere
from tests.synthesis.samples import blobs
from texloom.domain.faces import Faces
from texloom.exemplar.exemplar import from_array
from texloom.field.direction import from_constant
from texloom.field.smooth import smoothest
from texloom.mesh.mesh import Mesh
from texloom.search.textons import Textons, learn_textons

X = np.array([1.0, 0, 0])


def holes(rows: int, columns: int) -> ndarray:
    """A mask with two holes, one at the border."""
    mask = np.ones((rows, columns), bool)
    mask[rows // 2 : rows // 2 + 3, columns // 2 : columns // 2 + 5] = False
    mask[:4, -5:] = False
    return mask


@cache
def sample(rows: int = 30, columns: int = 36, masked: bool = False) -> Textons:
    """Blobs, their textons at eight orientations."""
    colours = blobs(max(rows, columns))[:rows, :columns]
    of = from_array(colours, mask=holes(rows, columns) if masked else None)
    return learn_textons(of, count=24, width=5, orientations=8)


@cache
def panes() -> Textons:
    """Blobs, masked along lines, so that patches mostly lie beside one."""
    mask = np.ones((41, 46), bool)
    mask[::10] = mask[:, ::9] = False
    return learn_textons(from_array(blobs(46)[:41], mask=mask), count=16, width=5, orientations=8)


def plane(cells: int, texels: float, order: int = 1) -> Faces:
    """A flat square of so many cells a side, each so many texels, along x."""
    mesh = flat_square(cells, size=cells * texels)
    return Faces.build(mesh, from_constant(mesh, order, X), texel=1.0)


def ball(order: int, across: float = 9.0, subdivisions: int = 2, **more: float) -> Faces:
    """A dented sphere along the smoothest field, its longest edge of so many texels."""
    mesh = sphere(subdivisions)
    dents = np.random.default_rng(1).normal(
        1, 0.05, mesh.vertices.shape
    )  # no two faces alike, none aligned with texels
    mesh = Mesh(mesh.vertices * dents, mesh.faces)
    return Faces.build(mesh, smoothest(mesh, order), texel=float(mesh.edge_lengths.max()) / across, **more)
