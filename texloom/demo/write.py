"""The demo material as files, as a user would have them."""

from pathlib import Path

import numpy as np

from texloom.demo.animal import rabbit
from texloom.demo.samples import draw
from texloom.mesh.mesh import Mesh
from texloom.output.atomic import atomic
from texloom.output.image import write_images

SIZE = 256
"""Texels a side of the samples, unless others are asked for."""


def write_sample(folder: Path, name: str, *, size: int = SIZE, seed: int = 0) -> list[Path]:
    """One sample as a folder of maps."""
    return write_images(folder, draw(name, size=size, seed=seed).maps)


def write_rabbit(path: Path) -> Path:
    """The demo animal as OBJ."""
    return write_obj(path, rabbit())


def write_obj(path: Path, mesh: Mesh) -> Path:
    """Positions and faces as OBJ text."""
    with atomic(path) as beside, beside.open("w", encoding="ascii") as file:
        np.savetxt(file, mesh.vertices, fmt="v %.6f %.6f %.6f")
        np.savetxt(file, mesh.faces + 1, fmt="f %d %d %d")
    return path
