"""A picture of what went wrong where: a mesh from several sides, its edges in the colour of their error."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float, Float32, Float64, Int, UInt8
from PIL import Image as Pillow
from PIL import ImageDraw, ImageFont

from texloom.exemplar.colour import decode
from texloom.exemplar.exemplar import Map
from texloom.mesh.mesh import Mesh
from texloom.output.blending import EdgeErrors
from texloom.output.preview import Skin, preview
from texloom.output.sample_uv import sample_uv

_LARGEST = 64.0  # of 255; greater errors have the last colour. Always the same, so that pictures can be compared
_UNSEEN = 2.0  # of 255; edges below are not drawn
_RAMP = np.array([[62, 36, 110], [150, 38, 108], [222, 82, 52], [250, 170, 38], [255, 255, 190]])  # sRGB
_STEPS, _BAND = 256, 16  # columns and rows of the ramp in the texture, rows between it and the sample
_WIDTH, _TINY = 1.5, 0.8  # pixels: an edge on each of its sides, radius of faces that are coloured whole
_INSIDE = 0.45  # of a face's radius at most, to its edges
_LEGEND = 64  # pixels high
_PAPER, _INK = (255, 255, 255), (40, 40, 44)


def edge_picture(
    mesh: Mesh,
    coordinates: Float[np.ndarray, "face 3 2"],
    errors: EdgeErrors,
    *,
    sample: Map,
    blended: Bool[np.ndarray, "edge"] | None = None,
    size: int = 512,
    views: int = 4,
) -> UInt8[np.ndarray, "row column 3"]:
    """Every edge in the colour of its E_t over the dimmed texture, with a legend in numbers.

    Colours run from 0 to 64 of 255 whatever the mesh, so that pictures can be compared; edges under 2 are left out.
    Faces smaller than a pixel or so take the colour of their worst edge. ``blended`` are counted in the legend.
    """
    faces = _drawn(mesh, errors.at_faces(errors.mean), _WIDTH * mesh.diagonal / size, _TINY * mesh.diagonal / size)
    texture = _texture(sample)
    corners = (faces.parent[:, None], faces.corners)
    uv = _uv(faces, coordinates, sample.image.shape[:2], texture.shape[:2])
    vertices, normals = (_inside(values[mesh.faces], *corners) for values in (mesh.vertices, mesh.vertex_normals))
    picture = preview(
        vertices.reshape(-1, 3),
        np.arange(3 * len(uv)).reshape(-1, 3),
        Skin(texture=texture, uv=uv, gloss=0.0),
        normals=normals.reshape(-1, 3),
        size=size,
        views=views,
    )
    return np.concatenate([picture, _legend(picture.shape[1], errors, blended)])


@dataclass(frozen=True, eq=False)
class _Drawn:
    """Pieces of faces: whose they are, their corners there (barycentric), and their error, -1 for the texture."""

    parent: Int[np.ndarray, "piece"]
    corners: Float64[np.ndarray, "piece 3 3"]
    error: Float32[np.ndarray, "piece"]


def _drawn(mesh: Mesh, error: Float32[np.ndarray, "face across"], width: float, tiny: float) -> _Drawn:
    """Cut faces into a middle and a strip along each edge, ``width`` wide; those without an edge to draw stay whole."""
    sides = np.linalg.norm(np.roll(mesh.vertices[mesh.faces], -1, 1) - np.roll(mesh.vertices[mesh.faces], 1, 1), axis=2)
    around = np.maximum(sides.sum(axis=1), np.finfo(np.float64).tiny)
    radius = 2 * mesh.face_areas / around
    bad = (error >= _UNSEEN).any(axis=1)
    whole, cut = np.flatnonzero(~bad | (radius < tiny)), np.flatnonzero(bad & (radius >= tiny))
    worst = np.where(bad, error.max(axis=1), -1.0)[whole]

    inwards = np.minimum(width / radius[cut], _INSIDE)[:, None, None]
    outer = np.broadcast_to(np.eye(3), (len(cut), 3, 3))
    inner = (1 - inwards) * outer + inwards * (sides[cut] / around[cut, None])[:, None]
    points = np.concatenate([outer, inner], axis=1)  # corners 0 1 2, then the same further in, 3 4 5
    pieces = [[3, 4, 5]]
    for k in range(3):
        a, b = (k + 1) % 3, (k + 2) % 3
        pieces += [[a, b, 3 + b], [a, 3 + b, 3 + a]]
    shown = np.where(error >= _UNSEEN, error, -1.0)[cut]
    strips = np.concatenate([np.full((len(cut), 1), -1.0), np.repeat(shown, 2, axis=1)], axis=1)
    return _Drawn(
        np.concatenate([whole, np.repeat(cut, len(pieces))]),
        np.concatenate([np.broadcast_to(np.eye(3), (len(whole), 3, 3)), points[:, pieces].reshape(-1, 3, 3)]),
        np.concatenate([worst, strips.reshape(-1)]).astype(np.float32),
    )


def _inside(
    values: Float[np.ndarray, "face 3 n"], parent: Int[np.ndarray, "piece 1"], corners: Float64[np.ndarray, "piece 3 3"]
) -> Float64[np.ndarray, "piece 3 n"]:
    """Values at the corners of faces, at the corners of pieces."""
    return np.einsum("pcb,pbn->pcn", corners, values[parent[:, 0]])


def _uv(
    faces: _Drawn, coordinates: np.ndarray, sample: tuple[int, int], texture: tuple[int, int]
) -> Float32[np.ndarray, "piece 3 2"]:
    """Pieces on the sample at the top of the texture, or on the colour of their error at its bottom."""
    uv = sample_uv(_inside(coordinates, faces.parent[:, None], faces.corners), texture)
    coloured = np.flatnonzero(faces.error >= 0)
    step = np.rint(np.minimum(faces.error[coloured] / _LARGEST, 1.0) * (_STEPS - 1))
    place = np.stack([np.full(len(step), texture[0] - _BAND / 2 - 0.5), step], axis=1)
    uv[coloured] = sample_uv(place, texture)[:, None]
    return uv


def _texture(sample: Map) -> Float32[np.ndarray, "row column 3"]:
    """The sample in dim grey, its last row on and on, and the ramp below."""
    rows, columns = sample.image.shape[:2]
    grey = 0.03 + 0.16 * np.clip(sample.image[..., :3].mean(axis=2), 0, 1)
    grey = np.pad(grey, ((0, 2 * _BAND), (0, max(_STEPS - columns, 0))), mode="edge")
    texture = np.repeat(grey[..., None], 3, axis=2).astype(np.float32)
    texture[rows + _BAND :, :_STEPS] = decode(_ramp())
    return texture


def _ramp() -> UInt8[np.ndarray, "step 3"]:
    """The colours from no error to the largest."""
    at = np.linspace(0, len(_RAMP) - 1, _STEPS)
    channels = [np.interp(at, np.arange(len(_RAMP)), _RAMP[:, c]) for c in range(3)]
    return np.rint(np.stack(channels, axis=1)).astype(np.uint8)


def _legend(
    width: int, errors: EdgeErrors, blended: Bool[np.ndarray, "edge"] | None
) -> UInt8[np.ndarray, "row column 3"]:
    """The ramp with numbers, and how the errors are spread: beside it, or below where there is no room."""
    told = _told(errors, blended)
    font = ImageFont.load_default(13)
    bar, left, top, line = max(width // 3, 120), 16, 16, 18
    beside = left + bar + 28 + max(font.getlength(text) for text in told) < width
    x, y = (left + bar + 28, top - 2) if beside else (left, top + 2 * line + 4)
    legend = Pillow.new("RGB", (width, _LEGEND if beside else _LEGEND + 2 * line + 4), _PAPER)
    draw = ImageDraw.Draw(legend)
    legend.paste(Pillow.fromarray(_ramp()[None]).resize((bar, 14)), (left, top))
    for tick in range(5):
        value = f"{_LARGEST * tick / 4:g}" + ("+" if tick == 4 else "")
        draw.text((left + bar * tick / 4, top + line), value, _INK, font, anchor="ma")
    for number, text in enumerate(told):
        draw.text((x, y + line * number), text, _INK, font)
    return np.asarray(legend)


def _told(errors: EdgeErrors, blended: Bool[np.ndarray, "edge"] | None) -> list[str]:
    """Two lines of text."""
    if not len(errors.mean):
        return ["no inner edges"]
    median, most, worst = np.percentile(errors.mean, [50, 95, 100])
    spread = f"mean {errors.mean.mean():.1f}, median {median:.1f}, 95 % under {most:.1f}, up to {worst:.1f}"
    count = f"{len(errors.mean)} edges" + ("" if blended is None else f", {int(blended.sum())} blended")
    return [f"difference, of 255: {spread}", count]
