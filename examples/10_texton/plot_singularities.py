"""Where the field has no direction.

A ball, seen where its field turns around a point: arrows (``--symmetry 1``) turn once, lines (2) half, crosses (4) a
quarter. Above textons of one orientation and each face alone, as in the paper; below of sixteen, in patches.

Magda & Kriegman 2003, "Fast texture synthesis on arbitrary meshes", figure 7.
"""

import numpy as np

import texloom
from examples.meshes import globe
from examples.pictures import Picture, below, beside
from examples.quilts import quilt, worn
from texloom.demo import draw
from texloom.field.singularities import indices
from texloom.mesh.mesh import Mesh
from texloom.output.camera import Camera
from texloom.search.textons import learn_textons
from texloom.systems import texton


def towards_singularity(mesh: Mesh, order: int) -> Camera:
    """A view of the singularity that lies most in front."""
    field = texloom.smoothest(mesh, order)
    middle = mesh.vertices[mesh.faces[indices(mesh, field) != 0]].mean(axis=1)
    x, y, z = middle[middle[:, 2].argmax()]
    return Camera(azimuth=np.degrees(np.arctan2(x, z)), elevation=np.degrees(np.arctan2(y, np.hypot(x, z))))


def picture(detail: float = 1.0) -> Picture:
    """Three symmetries, twice; ``detail`` scales the pictures' sides."""
    mesh, sample = globe(), draw("weave", size=192)
    published, ours = texton.textons(sample), learn_textons(sample)
    rows = [[], []]
    for order in (1, 2, 4):
        views, side = [towards_singularity(mesh, order)], round(400 * detail)
        alone = quilt(mesh, published, texton.quilting(), repeats=1.8, order=order, width=None)
        patches = quilt(mesh, ours, repeats=1.8, order=order)
        for row, quilted in zip(rows, (alone, patches), strict=True):
            row.append(worn(quilted, sample, views, side))
    return below(*(beside(*row, gap=0) for row in rows), gap=0)
