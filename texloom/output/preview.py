"""Pictures of a textured mesh, without a display: z-buffer, 2×2 samples a pixel, key, fill and sky light."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Float32, Int, UInt8

from texloom.kernels.launch import launch
from texloom.kernels.raster import draw_rows
from texloom.kernels.shade import shade_pixels
from texloom.output.camera import Camera, Projection, project, turntable
from texloom.output.image import encoded_picture
from texloom.output.rows import FaceRows, face_rows

_KEY, _FILL = np.array([-0.55, 0.62, -0.65]), np.array([0.85, 0.1, -0.5])  # towards the lights: right, up, ahead
_BACKGROUND = (0.80, 0.58)  # linear grey in the middle and in the corners
_NOTHING3, _NOTHING2, _NOTHING4 = (
    np.zeros((1, 3), np.float32),
    np.zeros((1, 3, 2), np.float32),
    np.zeros((1, 3, 4), np.float32),
)


@dataclass(frozen=True, eq=False, kw_only=True)
class Skin:
    """What a mesh shows, in linear light: colours at vertices, or a texture on corner UVs (v up), perhaps with normals.

    ``bumps`` is a packed normal map as large as the texture, in the frame of the glTF ``tangents``.
    """

    colours: Float[np.ndarray, "vertex 3"] | None = None
    texture: Float[np.ndarray, "row column 3"] | None = None
    uv: Float[np.ndarray, "face 3 2"] | None = None
    bumps: Float[np.ndarray, "row column 3"] | None = None
    tangents: Float[np.ndarray, "face 3 4"] | None = None
    gloss: float = 0.06  # strength of the highlight


def preview(
    vertices: Float[np.ndarray, "vertex 3"],
    faces: Int[np.ndarray, "face 3"],
    skin: Skin,
    *,
    normals: Float[np.ndarray, "vertex 3"],
    size: int = 512,
    views: int | Sequence[Camera] = 4,
) -> UInt8[np.ndarray, "row column 3"]:
    """An sRGB picture of a mesh from several sides, each ``size`` pixels square, in rows of two (or one, for up to 3).

    ``views`` is a number of turntable views or the cameras themselves; +y is up. Faces show from both sides.
    """
    cameras = turntable(views) if isinstance(views, int) else list(views)
    scene = _Scene(vertices, faces, normals, skin)
    pictures = [encoded_picture(scene.picture(camera, size)) for camera in cameras]
    across = len(pictures) if len(pictures) < 4 else -(-len(pictures) // 2)
    across = 2 if len(pictures) == 4 else across
    blank = np.full_like(pictures[0], 225)
    pictures += [blank] * (-len(pictures) % across)
    rows = [np.concatenate(pictures[i : i + across], axis=1) for i in range(0, len(pictures), across)]
    return np.concatenate(rows, axis=0)


class _Scene:
    """Arrays of a mesh and its skin as the kernels take them, for any number of views."""

    def __init__(self, vertices: np.ndarray, faces: np.ndarray, normals: np.ndarray, skin: Skin) -> None:
        self.centre = (vertices.min(axis=0) + vertices.max(axis=0)) / 2
        self.vertices = _floats(vertices - self.centre)
        self.faces = np.ascontiguousarray(faces, np.int32)
        self.normals = _floats(normals)
        self.gloss = float(skin.gloss)
        self.skin = self._skin_arrays(skin)

    @staticmethod
    def _skin_arrays(skin: Skin) -> list:
        if skin.texture is None or skin.uv is None:
            assert skin.colours is not None, "a skin has colours, or a texture and its uv"
            one = np.zeros(1, np.int32)
            return [_floats(skin.colours), _NOTHING2, _NOTHING3, one, 0, 0, _NOTHING3, 0, _NOTHING4]
        texture, first = _pyramid(skin.texture)
        rows, columns = skin.texture.shape[:2]
        common = [_NOTHING3, _floats(skin.uv), texture, first, rows, columns]
        if skin.bumps is None or skin.tangents is None:
            return [*common, _NOTHING3, 0, _NOTHING4]
        return [*common, _pyramid(skin.bumps)[0], 1, _floats(skin.tangents)]

    def picture(self, camera: Camera, size: int) -> Float32[np.ndarray, "row column 3"]:
        """One view over the background, in linear light."""
        samples = 2 * size
        projection = project(self.vertices, camera, samples)
        corners = projection.screen[self.faces]
        rows = face_rows(corners, samples)
        inverse = (1 / projection.distance if projection.perspective else -projection.distance)[self.faces]
        visible, depth = np.empty((samples, samples), np.int32), np.empty((samples, samples), np.float32)
        launch(draw_rows, samples, inputs=[*rows.arrays, inverse], outputs=[visible, depth])
        light, cover = self._shaded(projection, rows, visible, inverse, size)
        return light + (1 - cover[..., None]) * _background(size)

    def _shaded(
        self, projection: Projection, rows: FaceRows, visible: np.ndarray, inverse: np.ndarray, size: int
    ) -> tuple[np.ndarray, np.ndarray]:
        """Light and cover of every pixel."""
        right_up_ahead = projection.axes
        key, fill = (_vec3(_unit(light @ right_up_ahead)) for light in (_KEY, _FILL))
        nearness = inverse if projection.perspective else np.ones_like(inverse)
        light, cover = np.empty((size * size, 3), np.float32), np.empty(size * size, np.float32)
        camera = [_vec3(projection.eye), _vec3(right_up_ahead[2]), int(projection.perspective)]
        lights = [key, fill, _vec3(np.array([0.0, 1.0, 0.0])), self.gloss]
        mesh = [self.faces, self.vertices, self.normals]
        inputs = [visible, rows.corners, nearness, *mesh, *self.skin, *camera, *lights]
        launch(shade_pixels, size * size, inputs=inputs, outputs=[light, cover])
        return light.reshape(size, size, 3), cover.reshape(size, size)


def _pyramid(texture: np.ndarray) -> tuple[Float32[np.ndarray, "texel 3"], Int[np.ndarray, "level"]]:
    """A texture halved again and again (box filter), all levels in one array, and where each begins."""
    level = _floats(texture)
    levels = [level]
    while min(level.shape[:2]) >= 2:
        rows, columns = level.shape[0] // 2 * 2, level.shape[1] // 2 * 2
        even = level[:rows, :columns]
        level = 0.25 * (even[0::2, 0::2] + even[1::2, 0::2] + even[0::2, 1::2] + even[1::2, 1::2])
        levels.append(level)
    sizes = [len(level.reshape(-1, 3)) for level in levels]
    return np.concatenate([level.reshape(-1, 3) for level in levels]), np.cumsum([0, *sizes[:-1]]).astype(np.int32)


def _background(size: int) -> Float32[np.ndarray, "row column 3"]:
    """A soft grey, darker towards the corners."""
    across = np.linspace(-1, 1, size, dtype=np.float32)
    far = np.minimum((across[None, :] ** 2 + (across[:, None] + 0.15) ** 2) / 2, 1)
    middle, corner = _BACKGROUND
    return np.repeat((middle + (corner - middle) * far)[..., None], 3, axis=2)


def _unit(vector: np.ndarray) -> np.ndarray:
    return vector / np.linalg.norm(vector)


def _vec3(vector: np.ndarray) -> tuple[float, float, float]:
    """A vector as a kernel argument."""
    x, y, z = (float(value) for value in vector)
    return x, y, z


def _floats(values: np.ndarray) -> Float32[np.ndarray, "..."]:
    return np.ascontiguousarray(values, np.float32)
