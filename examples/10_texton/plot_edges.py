"""Edges that do not fit, and by how much.

How much the two sides of each edge differ: in the paper's growth, in ours before any round, and after two rounds in
which the worse half of the faces choose anew. Edges under 2 of 255 are not drawn, what is dim there is texture.
``texloom surface --edges FILE`` makes such a picture.

Magda & Kriegman 2003, "Fast texture synthesis on arbitrary meshes", sections 3.3.2 and 5.
"""

from examples.pictures import Picture, beside
from examples.quilts import quilt
from texloom.demo import draw, rabbit
from texloom.output.blending import edge_errors
from texloom.output.edge_picture import edge_picture
from texloom.search.textons import learn_textons
from texloom.synthesis.quilting import Quilting
from texloom.systems import texton


def picture(detail: float = 1.0) -> Picture:
    """Three pictures of edges; ``detail`` scales their sides."""
    mesh, sample = rabbit(step=0.05), draw("bricks", size=192)
    textons = learn_textons(sample)
    published = quilt(mesh, texton.textons(sample), texton.quilting(), width=None)
    grown, improved = (quilt(mesh, textons, Quilting(rounds=rounds), width=None) for rounds in (0, 2))
    pictures = []
    for quilted in (published, grown, improved):
        errors = edge_errors(mesh, quilted.coordinates, textons.image)
        shown = {"sample": sample.lead, "size": round(480 * detail), "views": 1}
        pictures.append(edge_picture(mesh, quilted.coordinates, errors, **shown))
    return beside(*pictures)
