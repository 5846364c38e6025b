"""Even points in levels.

400, 1200 and 3600 points on a rabbit, each set with its own triangulation on the surface. A dot's colour tells the
coarsest level that has it: the points of a level stay in all finer ones.

Turk 2001, "Texture Synthesis on Surfaces" (the talk's slides).
"""

import numpy as np

from examples.pictures import FRONT, Picture, beside
from texloom.demo import rabbit
from texloom.exemplar.colour import decode
from texloom.output.preview import Skin, preview
from texloom.points import Level, hierarchy

COUNTS = (400, 1200, 3600)
DOTS = decode(np.array([[200, 36, 44], [240, 160, 20], [40, 96, 168]], np.uint8))  # by coarsest level
PAPER, INK = decode(np.array([[240, 236, 228], [120, 116, 114]], np.uint8))
WIDTH, SMALL, LARGE, LIFT = 0.04, 0.18, 0.32, 0.02  # of a face: edges; of a spacing: dots, new and old, above it
SIDES = ((0, 1, 2), (1, 2, 0), (2, 0, 1))


def drawn(level: Level) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Corners, normals and colours of pieces of faces: paper, edges around it, a sixth of the dot at each corner."""
    outer = np.eye(3)
    paper = outer + WIDTH * (1 - 3 * outer)
    edges = [(outer[a], *far) for a, b, _ in SIDES for far in ((outer[b], paper[b]), (paper[b], paper[a]))]
    sectors = [(outer[a], outer[b], outer[a] + (1 - 3 * outer[a]) / 3**0.5) for a, *both in SIDES for b in both]
    pieces = np.array([paper, *edges, *sectors])
    faces = level.mesh.faces
    corners, normals = (np.einsum("pcb,fbx->fpcx", pieces, values[faces]) for values in (level.position, level.normal))
    birth = np.searchsorted(COUNTS, np.repeat(faces, 2, axis=1), side="right")
    radius = np.where(birth < birth.max(), LARGE, SMALL)[:, :, None, None]
    middle = corners[:, -6:, :1] + LIFT * level.spacing * normals[:, -6:]
    corners[:, -6:] = middle + radius * (corners[:, -6:] - corners[:, -6:, :1])
    tints = np.broadcast_to([PAPER, *[INK] * 6], (len(faces), 7, 3))
    colours = np.repeat(np.concatenate([tints, DOTS[birth]], axis=1), 3, axis=1)
    return corners.reshape(-1, 3), normals.reshape(-1, 3), colours.reshape(-1, 3)


def picture(detail: float = 1.0) -> Picture:
    """Three levels beside each other; ``detail`` scales the pictures' sides."""
    side, views = round(510 * detail), []
    for level in hierarchy(rabbit(), COUNTS).levels:
        corners, normals, colours = drawn(level)
        faces, skin = np.arange(len(corners)).reshape(-1, 3), Skin(colours=colours, gloss=0.0)
        views.append(preview(corners, faces, skin, normals=normals, size=side, views=[FRONT]))
    return beside(*(view[:, side // 5 : -side // 5] for view in views), gap=0)
