"""Cameras that look at a mesh and fill the picture with it."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Float32, Float64


@dataclass(frozen=True, kw_only=True)
class Camera:
    """A view: where from (degrees), how wide. ``azimuth`` turns about +y from +z towards +x; ``elevation`` is upwards.

    ``field_of_view`` is in degrees, across the picture; 0 is an orthographic view.
    """

    azimuth: float = 35.0
    elevation: float = 18.0
    field_of_view: float = 28.0
    margin: float = 0.06  # of the picture, left free on every side


@dataclass(frozen=True, eq=False)
class Projection:
    """Vertices in a picture: (column, row) in samples, distance ahead of the eye, and the view's axes in the world."""

    screen: Float32[np.ndarray, "vertex 2"]
    distance: Float32[np.ndarray, "vertex"]
    axes: Float64[np.ndarray, "right_up_ahead 3"]
    eye: Float64[np.ndarray, "3"]
    perspective: bool


def turntable(views: int, camera: Camera | None = None) -> list[Camera]:
    """Cameras evenly around the upright axis, the first at the given one."""
    start = camera or Camera()
    return [
        Camera(
            azimuth=start.azimuth + 360.0 * view / views,
            elevation=start.elevation,
            field_of_view=start.field_of_view,
            margin=start.margin,
        )
        for view in range(views)
    ]


def project(vertices: Float[np.ndarray, "vertex 3"], camera: Camera, samples: int) -> Projection:
    """Aim at the mesh from the camera's side so that it just fits a square picture of ``samples`` a side."""
    axes = _axes(camera)
    low, high = vertices.min(axis=0), vertices.max(axis=0)
    centre = (low + high) / 2
    seen = (vertices - centre).astype(np.float32) @ axes.T.astype(np.float32)
    radius = max(float(np.sqrt(np.einsum("ij,ij->i", seen, seen).max())), 1e-30)
    half = np.tan(np.radians(camera.field_of_view) / 2)
    perspective = camera.field_of_view > 0
    back = radius / np.sin(np.radians(camera.field_of_view) / 2) if perspective else 2 * radius
    distance = seen[:, 2] + np.float32(back)
    flat = seen[:, :2] / distance[:, None] / np.float32(half) if perspective else seen[:, :2]
    screen = _fitted(flat, samples, camera.margin)
    return Projection(screen, distance, axes, centre - back * axes[2], perspective)


def _fitted(flat: Float32[np.ndarray, "vertex 2"], samples: int, margin: float) -> Float32[np.ndarray, "vertex 2"]:
    """Positions (right, up) centred and enlarged to fill the picture, as (column, row)."""
    low, high = flat.min(axis=0), flat.max(axis=0)
    size = max(float((high - low).max()), 1e-30)
    scale = np.float32(samples * (1 - 2 * margin) / size)
    middle = np.float32((samples - 1) / 2)
    return (flat - (low + high) / 2) * np.array([scale, -scale], np.float32) + middle


def _axes(camera: Camera) -> Float64[np.ndarray, "right_up_ahead 3"]:
    """Right, up and ahead in the world."""
    turn, rise = np.radians(camera.azimuth), np.radians(camera.elevation)
    ahead = -np.array([np.sin(turn) * np.cos(rise), np.sin(rise), np.cos(turn) * np.cos(rise)])
    right = np.array([np.cos(turn), 0.0, -np.sin(turn)])
    return np.stack([right, np.cross(right, ahead), ahead])
