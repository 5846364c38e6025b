"""A tilted cylinder, which is a plane rolled up: what a picture laid on it shows is known everywhere.

Upright, as frames see it, leans against the plane's axes by more and by less along the way around. So the frames of a
symmetric field change from one of its directions to the next where neither field nor picture does.
"""

import numpy as np
from numpy import ndarray

from tests.meshes import as_mesh, cylinder
from texloom.domain.surface import Surface
from texloom.field.direction import from_vectors

TEXEL = 0.1
TILT = np.pi / 3  # of the axis against upright
_AXES = np.array([[1, 0, 0], [0, np.sin(TILT), -np.cos(TILT)], [0, np.cos(TILT), np.sin(TILT)]])  # rows: own x, y, z


def rolled(order: int) -> Surface:
    """Radius and height 1, about 70 sites a texel apart around and 11 along; one direction of the field is around."""
    own = cylinder(96, 12, height=1.0)
    around = np.cross([0.0, 0, 1], own.vertices)
    mesh = as_mesh(own.vertices @ _AXES, own.faces)
    return Surface.build(mesh, from_vectors(mesh, order, around @ _AXES), texel=TEXEL)


def unrolled(domain: Surface) -> ndarray:
    """[row, column] texels of ``rolled`` in the plane, of the sites of a domain on it: columns run around."""
    x, y, z = (domain.refined.mesh.vertices @ _AXES.T).T
    return np.stack([-z, np.arctan2(y, x)], axis=1) / TEXEL


def turned(domain: Surface) -> ndarray:
    """By how much the plane's axes are turned against the frame of each site, radians."""
    x, y, _ = (domain.refined.mesh.vertices @ _AXES.T).T
    along, across, up = (domain.direction @ _AXES.T).T
    return -np.arctan2(up, (x * across - y * along) / np.hypot(x, y))


def inner(domain: Surface, margin: float) -> ndarray:
    """Sites ``margin`` texels and more away from the line where the plane's two sides meet."""
    return np.abs(unrolled(domain)[:, 1]) < np.pi / TEXEL - margin
