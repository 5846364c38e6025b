"""The demo animal: a rabbit sitting up, about two units tall, y up, looking along +z."""

import numpy as np

from texloom.demo.polygonise import polygonise
from texloom.demo.shapes import Shape, ball, carve, limb, mirrored, union
from texloom.mesh.mesh import Mesh


def rabbit(*, step: float = 0.035) -> Mesh:
    """A closed mesh of even triangles, genus 0; ``step`` is about the length of an edge."""
    return polygonise(_rabbit(), low=np.array([-0.85, -0.15, -1.05]), high=np.array([0.85, 2.5, 0.95]), step=step)


def _rabbit() -> Shape:
    """Soft parts melted together, ears last so that their gap stays open."""
    belly = ball((0, 0.58, -0.12), (0.52, 0.56, 0.58), pitch=0.25)
    chest = ball((0, 0.78, 0.10), (0.37, 0.46, 0.36))
    haunch = mirrored(ball((0.36, 0.36, -0.10), (0.26, 0.36, 0.42)))
    foot = mirrored(ball((0.33, 0.11, 0.30), (0.15, 0.13, 0.30)))
    arm = mirrored(limb((0.21, 0.66, 0.30), (0.17, 0.16, 0.42), 0.13, 0.12))
    tail = ball((0, 0.38, -0.72), 0.19)
    torso = union([union([belly, chest], blend=0.2), haunch, arm, foot, tail], blend=0.10)

    skull = ball((0, 1.34, 0.20), (0.35, 0.33, 0.36))
    snout = ball((0, 1.23, 0.50), (0.20, 0.16, 0.18))
    cheek = mirrored(ball((0.19, 1.21, 0.36), 0.16))
    nose = ball((0, 1.29, 0.66), (0.06, 0.045, 0.05))
    eye = mirrored(ball((0.235, 1.40, 0.40), 0.085))
    head = union([skull, snout, cheek, nose, eye], blend=0.07)

    blade = ball((0.25, 1.90, 0.02), (0.165, 0.42, 0.10), pitch=-0.22, roll=-0.20)
    hollow = ball((0.255, 1.87, 0.135), (0.10, 0.33, 0.07), pitch=-0.22, roll=-0.20)
    ear = mirrored(carve(blade, hollow, blend=0.05))
    return union([torso, head, ear], blend=0.07)
