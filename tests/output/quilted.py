"""Faces thrown on a sample: flat, at a scale and along a direction, each at a random place and turn."""

import numpy as np

from texloom.mesh.mesh import Mesh


def thrown(mesh: Mesh, shape: tuple[int, int], *, texel: float, seed: int = 0, turned: bool = True) -> np.ndarray:
    """Coordinates (face 3 2) inside a sample of ``shape``."""
    rng = np.random.default_rng(seed)
    corners = mesh.vertices[mesh.faces]
    axes = mesh.face_frames
    local = np.einsum("fci,fai->fca", corners - corners.mean(1, keepdims=True), axes) / texel
    places = local[..., 0] - 1j * local[..., 1]  # column + 1j row, seen from outside
    places *= np.exp(1j * rng.uniform(-np.pi, np.pi, (len(places), 1)) * turned)
    low = np.stack([places.imag, places.real], axis=-1)
    room = np.array(shape) - 1 - np.ptp(low, axis=1)
    assert (room > 0).all(), "a face is larger than the sample"
    return (low - low.min(1, keepdims=True) + (rng.random((len(low), 2)) * room)[:, None]).astype(np.float32)


def continued(mesh: Mesh, size: float, *, turn: float = 0.7) -> np.ndarray:
    """Coordinates of a flat mesh (z = 0) in one map: every face goes on where its neighbours end."""
    at = (mesh.vertices[:, 0] - 1j * mesh.vertices[:, 1]) * np.exp(1j * turn)
    at = (at - at.mean()) * size / np.abs(at - at.mean()).max()
    return np.stack([at.imag + size + 1, at.real + size + 1], axis=-1)[mesh.faces].astype(np.float32)
