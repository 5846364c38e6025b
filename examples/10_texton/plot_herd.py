"""One sample for all.

Textons are learnt once and kept; then a mesh takes milliseconds and no texture memory: these twenty rabbits, no two
alike, all show the one picture of 192 × 192 texels in the corner. ``texloom surface FOLDER FILE.textons -o FOLDER``
makes such a herd.

Magda & Kriegman 2003, "Fast texture synthesis on arbitrary meshes", section 1.
"""

import numpy as np

import texloom
from examples.pictures import Picture, inset, of_map
from examples.quilts import skin_of
from texloom import draws
from texloom.demo import draw, rabbit
from texloom.domain.faces import Faces
from texloom.mesh.mesh import Mesh
from texloom.output.camera import Camera
from texloom.output.preview import preview
from texloom.search.textons import learn_textons
from texloom.synthesis.quilting import Quilting

ROWS, COLUMNS, TEXEL = 4, 5, 0.006
VIEW = Camera(azimuth=0, elevation=33, margin=0.02)


def another(mesh: Mesh, number: int) -> Mesh:
    """A rabbit of another build, at another place, looking elsewhere."""
    stout, tall, turn = draws.uniform(3, index=3 * number + np.arange(3))
    (row, column), angle = divmod(number, COLUMNS), 2.6 * (turn - 0.5)
    x, y, z = (mesh.vertices * [0.75 + 0.4 * stout, 0.75 + 0.45 * tall, 0.75 + 0.4 * stout]).T
    place = [1.9 * column + 0.95 * (row % 2), 0, -2.3 * row]
    around = [np.cos(angle) * x + np.sin(angle) * z, y, np.cos(angle) * z - np.sin(angle) * x]
    return Mesh(np.stack(around, axis=1) + place, mesh.faces)


def picture(detail: float = 1.0) -> Picture:
    """A herd; ``detail`` scales the picture's side."""
    textons, herd, coordinates, side = learn_textons(draw("weave", size=192)), [], [], round(1200 * detail)
    for number in range(ROWS * COLUMNS):
        herd.append(another(rabbit(step=0.06), number))
        faces = Faces.build(herd[-1], texloom.smoothest(herd[-1], 1), texel=TEXEL, width=48.0)
        coordinates.append(Quilting().run(textons, faces).coordinates)
    start = np.cumsum([0, *(len(mesh.vertices) for mesh in herd[:-1])])
    faces = np.concatenate([mesh.faces + first for mesh, first in zip(herd, start, strict=True)])
    whole = Mesh(np.concatenate([mesh.vertices for mesh in herd]), faces)
    skin = skin_of(whole, np.concatenate(coordinates), textons.exemplar)
    shown = preview(whole.vertices, whole.faces, skin, normals=whole.vertex_normals, size=side, views=[VIEW])
    return inset(shown[side // 6 : -side // 7], of_map(textons.exemplar.lead), side=96)
