"""A face alone, or many as one.

Where triangles are smaller than what the texture shows, one alone cannot hold it. From left to right: the paper's
growth, in random order by textons alone; ours, each face alone; ours, faces laid flat together in patches a quarter of
the sample wide. Mesh, sample and field are the same.

Magda & Kriegman 2003, "Fast texture synthesis on arbitrary meshes", sections 3.2.2 and 4.
"""

from examples.pictures import FRONT, Picture, beside, inset, of_map
from examples.quilts import quilt, worn
from texloom.demo import draw, rabbit
from texloom.search.textons import learn_textons
from texloom.systems import texton


def picture(detail: float = 1.0) -> Picture:
    """Three quilts of a rabbit; ``detail`` scales the size of the texture on it."""
    mesh, sample = rabbit(step=0.055), draw("bricks", size=192)
    textons, repeats = learn_textons(sample), 2.2 / detail
    quilts = (
        quilt(mesh, texton.textons(sample), texton.quilting(), repeats=repeats, width=None),
        quilt(mesh, textons, repeats=repeats, width=None),
        quilt(mesh, textons, repeats=repeats),
    )
    return inset(beside(*(worn(each, sample, [FRONT])[:, 105:-105] for each in quilts), gap=0), of_map(sample.lead))
