"""Every map of the sample, worn.

Coordinates into the sample serve all its maps: the stack that came in is the material that goes out. Left the sample's
maps; then a duck in its colours alone, in its normals alone, in both. Tangents follow the field, so bumps catch the
light from where it comes.

Magda & Kriegman 2003, "Fast texture synthesis on arbitrary meshes", section 5 (other texture data).
"""

import numpy as np

from examples.meshes import duck
from examples.pictures import Picture, below, beside, of_map
from examples.quilts import quilt
from texloom.demo import draw
from texloom.output.camera import Camera
from texloom.output.preview import Skin, preview
from texloom.output.sample_uv import on_sample
from texloom.search.textons import learn_textons

VIEW = Camera(azimuth=50, elevation=12)


def picture(detail: float = 1.0) -> Picture:
    """Maps, and a duck three times; ``detail`` scales the pictures' sides."""
    sample, mesh, side = draw("knit", size=192), duck(), round(480 * detail)
    shown = on_sample(mesh, quilt(mesh, learn_textons(sample), repeats=2.5).coordinates, sample.shape)
    colours, normals = sample.maps["basecolor"].image, sample.maps["normal"].image
    white = np.full_like(colours, 0.5)
    ducks = [
        Skin(texture=colours, uv=shown.uv),
        Skin(texture=white, uv=shown.uv, bumps=normals, tangents=shown.tangents),
        Skin(texture=colours, uv=shown.uv, bumps=normals, tangents=shown.tangents),
    ]
    maps = (of_map(sample.maps[name])[:152, :152] for name in ("basecolor", "normal", "height"))
    views = (preview(mesh.vertices, mesh.faces, s, normals=mesh.vertex_normals, size=side, views=[VIEW]) for s in ducks)
    return beside(below(*maps), *views)
