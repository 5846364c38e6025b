"""How large are the pieces of the sample that a textured surface shows unbroken: by its sources, or by its colours."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float32, Float64, Int

from texloom.arrays import Image, in_fours
from texloom.domain.neighbourhoods import Stencils, as_stencils
from texloom.domain.surface import Surface
from texloom.exemplar.blas import over_blocks
from texloom.exemplar.pca import fit
from texloom.metrics.patches import SIDE, Usable, patch_places, patch_vectors
from texloom.search.tree import KdTree
from texloom.sources import SourceMap
from texloom.synthesis.canvas import Canvas
from texloom.synthesis.visits import Guide, Visits

_APART = 0.5  # texels from where a neighbour's source leads
_ALIGNED = 0.87  # cosine of the angle between sources that continue each other
_DIMENSIONS = 12  # windows are compared in
_ROUNDS = 8  # in which sources spread to the next sites
_BLOCK = 1024  # windows read at once

Pairs = Int[np.ndarray, "pair 2"]


def surface_copy_side(sources: SourceMap, surface: Surface) -> float:
    """Side in texels of the typical piece of the sample shown unbroken: √(area-weighted mean area of pieces).

    Neighbouring sites are of one piece where the heaviest source of one continues that of the other to within half a
    texel. Only neighbours are asked: where the field turns, a piece may drift as far as it likes. Sites without a
    source (weight 0) count for nothing.
    """
    shown = sources.weight[:, 0] > 0
    if not shown.any():
        return 0.0
    edges = surface.edges[shown[surface.edges].all(axis=1)]
    joined = _continued(sources, surface, edges) | _continued(sources, surface, edges[:, ::-1])
    area = surface.area.astype(np.float64)
    areas = np.bincount(_pieces(edges[joined], surface.count)[shown], area[shown])
    return float(np.sqrt(np.square(areas).sum() / areas.sum()))


def apparent_sources(
    sample: Image, surface: Surface, values: Float32[np.ndarray, "site channel"], *, usable: Usable = None
) -> SourceMap:
    """Where each site seems to be from, by what it and its neighbours show; both pictures encoded.

    First the window of the sample most like its own: 7×7 texels, the surface's along its field, the sample's at every
    texel and in every direction of a symmetric field, compared in twelve principal components. Then, in eight rounds,
    sites try what their neighbours continue, and keep what fits the texels next to them best.

    Where pieces are large, seven or eight sites in ten are found to the texel, else four to six. What is missed lies
    where pieces meet, so a typical piece comes out up to a quarter smaller than by the true sources; but pieces that
    meet unseen count as one. Sites whose window a border or a singularity cuts short have no source (weight 0).
    """
    turns = 2 * np.pi / surface.field.order * np.arange(surface.field.order)
    windows = [_Windows.of(sample, usable, turn) for turn in turns]
    canvas = Canvas.empty(surface.count, -(-values.shape[1] // 4) * 4)
    canvas.colour[:, : values.shape[1]] = values
    stencils = surface.stencils(SIDE)
    whole = np.flatnonzero((stencils.sites[..., 0] >= 0).all(axis=1))
    canvas.label[whole] = 0
    if len(whole) and sum(len(each.middle) for each in windows):
        canvas.position[whole], canvas.turn[whole] = _most_alike(stencils, whole, values, windows)
        _spread(sample, surface, canvas, usable)
    weight = (canvas.label >= 0).astype(np.float32)
    return SourceMap(canvas.position[:, None], weight[:, None], canvas.turn[:, None])


@dataclass(frozen=True, eq=False)
class _Windows:
    """All windows of the sample in axes turned against its own, and where in it their middles lie.

    ``beside`` are those a texel before and after along each of the turned axes; the window itself at a border.
    """

    turn: float
    vectors: Float32[np.ndarray, "window dim"]
    middle: Float32[np.ndarray, "window 2"]
    beside: Int[np.ndarray, "window axis side"]

    @staticmethod
    def of(sample: Image, usable: Usable, turn: float) -> "_Windows":
        """The windows of the sample turned as a whole."""
        from scipy.ndimage import map_coordinates

        place = _turned_lattice(sample.shape[:2], turn)
        row, column = np.rint(place).astype(int)
        inside = np.ones(row.shape, bool)
        for axis, side in zip((row, column), sample.shape, strict=False):
            inside &= (axis >= 0) & (axis < side)
        if usable is not None:
            inside[inside] = usable[row[inside], column[inside]]
        channels = [map_coordinates(channel, place, order=1, mode="nearest") for channel in np.moveaxis(sample, 2, 0)]
        turned = np.stack(channels, axis=2)
        corner = patch_places(turned, inside)
        row, column = (corner + SIDE // 2).T
        middle = place[:, row, column].T.astype(np.float32)
        return _Windows(turn, patch_vectors(turned, inside), middle, _beside(corner))


def _beside(places: Int[np.ndarray, "window 2"]) -> Int[np.ndarray, "window axis side"]:
    """Numbers of the places one before and one after along rows and columns; the place itself where there is none."""
    own = np.arange(len(places))
    number = np.full(places.max(axis=0, initial=0) + 3, -1)
    number[places[:, 0] + 1, places[:, 1] + 1] = own
    steps = np.array([[[-1, 0], [1, 0]], [[0, -1], [0, 1]]])
    row, column = np.moveaxis(places[:, None, None] + 1 + steps, -1, 0)
    found = number[row, column]
    return np.where(found < 0, own[:, None, None], found)


def _turned_lattice(shape: tuple[int, int], turn: float) -> Float64[np.ndarray, "2 row column"]:
    """Places in a picture of a lattice about its middle that covers it, turned by an angle."""
    cosine, sine = np.cos(turn), np.sin(turn)
    size = np.ceil(np.abs([[cosine, sine], [sine, cosine]]) @ shape - 1e-6)
    rows, columns = (max(int(side), SIDE) for side in size)
    row, column = np.meshgrid(*(np.arange(n) - (n - 1) / 2 for n in (rows, columns)), indexing="ij")
    place = np.stack([cosine * row + sine * column, cosine * column - sine * row])
    return place + (np.array(shape)[:, None, None] - 1) / 2


def _most_alike(
    stencils: Stencils, whole: Int[np.ndarray, "n"], values: np.ndarray, windows: list[_Windows]
) -> tuple[Float32[np.ndarray, "n 2"], Float32[np.ndarray, "n"]]:
    """For some stencils the middle of the window most like what each shows, and how that is turned.

    Between texels by a step of Gauss & Newton: components of windows change as the pictures do.
    """
    assert stencils.weights is not None
    read, weights, projection = stencils.sites, stencils.weights, fit(windows[0].vectors, _DIMENSIONS)
    known = np.concatenate([projection(each.vectors) for each in windows])
    queries = np.empty((len(whole), known.shape[1]), np.float32)

    def show(first: int, last: int) -> None:
        own = whole[first:last]
        shown = np.einsum("nkc,nkcv->nvk", weights[own], values[read[own]])
        queries[first:last] = (shown.reshape(len(own), -1) - projection.mean) @ projection.axes

    over_blocks(show, len(whole), _BLOCK)
    found = KdTree.of(known).nearest(queries, 1)[0][:, 0]
    start = np.cumsum([0, *(len(each.middle) for each in windows)])
    beside = np.concatenate([each.beside + first for each, first in zip(windows, start, strict=False)])[found]
    slope = (known[beside[..., 1]] - known[beside[..., 0]]) / 2
    row, column = _least_squares(slope, queries - known[found]).clip(-0.5, 0.5).T
    turn = np.repeat([each.turn for each in windows], np.diff(start))[found].astype(np.float32)
    cosine, sine = np.cos(turn), np.sin(turn)
    way = np.stack([cosine * row + sine * column, cosine * column - sine * row], axis=1)
    return (np.concatenate([each.middle for each in windows])[found] + way).astype(np.float32), turn


def _least_squares(
    slope: Float32[np.ndarray, "n 2 dim"], difference: Float32[np.ndarray, "n dim"]
) -> Float32[np.ndarray, "n 2"]:
    """The steps along two slopes that come nearest to the differences; hardly any where nothing rises."""
    matrix = np.einsum("nad,nbd->nab", slope, slope)
    matrix[:, [0, 1], [0, 1]] += 1e-6
    return np.linalg.solve(matrix, np.einsum("nad,nd->na", slope, difference)[..., None])[..., 0]


def _spread(sample: Image, surface: Surface, canvas: Canvas, usable: Usable) -> None:
    """Let sites take over what their neighbours continue, where that fits better; colours stay."""
    texels, sites = sample.shape[:2], np.arange(surface.count, dtype=np.int32)
    allowed = np.ones(texels, np.uint8) if usable is None else usable.astype(np.uint8)
    guide = Guide(in_fours(sample), allowed, np.zeros((*texels, 0, 2), np.int32), suggesting=0)
    around, shown = surface.neighbourhoods(sites, 1), canvas.colour.copy()
    visits = Visits(guide, canvas, around, as_stencils(around))
    for _ in range(_ROUNDS):
        visits.at_once(np.flatnonzero(canvas.label >= 0).astype(np.int32))
        canvas.colour[:] = shown


def _continued(sources: SourceMap, surface: Surface, pairs: Pairs) -> Bool[np.ndarray, "pair"]:
    """Whether the source of the second site lies where that of the first leads, and is turned as that is."""
    one, other = pairs.T
    offset, frame_turn = _laid(surface, one, other)
    turn = np.zeros(surface.count) if sources.turn is None else sources.turn[:, 0].astype(np.float64)
    scale = np.ones(surface.count) if sources.scale is None else sources.scale[:, 0].astype(np.float64)
    cosine, sine = np.cos(turn[one]), np.sin(turn[one])
    row, column = offset.T / scale[one]
    leads = np.stack([cosine * row + sine * column, cosine * column - sine * row], axis=1)
    apart = sources.position[other, 0] - sources.position[one, 0] - leads
    aligned = np.cos(turn[other] - turn[one] - frame_turn) > _ALIGNED
    return aligned & (np.einsum("pc,pc->p", apart, apart) <= _APART**2)


def _laid(
    surface: Surface, one: Int[np.ndarray, "pair"], other: Int[np.ndarray, "pair"]
) -> tuple[Float64[np.ndarray, "pair 2"], Float64[np.ndarray, "pair"]]:
    """Offsets to the other sites and turns of the frames, as ``Neighbourhoods`` has them, however far they are."""
    way = surface.refined.mesh.vertices[other] - surface.refined.mesh.vertices[one]
    direction, beside = surface.direction[one], surface.direction[other]
    up = np.cross(surface.normal[one], direction)
    offset = np.stack([-_dot(way, up), _dot(way, direction)], axis=1)
    stretch = np.linalg.norm(way, axis=1) / np.maximum(np.linalg.norm(offset, axis=1), 1e-20)
    branch = 2 * np.pi / surface.field.order
    turn = np.rint(-np.arctan2(_dot(beside, up), _dot(beside, direction)) / branch) * branch
    return offset * (stretch / surface.texel_length[one])[:, None], turn if surface.field.order > 1 else 0.0 * turn


def _pieces(joined: Pairs, count: int) -> Int[np.ndarray, "site"]:
    """Numbers of the pieces that sites belong to, where these pairs hang together."""
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    graph = coo_array((np.ones(len(joined), bool), tuple(joined.T)), shape=(count, count))
    return connected_components(graph, directed=False)[1]


def _dot(a: Float64[np.ndarray, "n 3"], b: Float64[np.ndarray, "n 3"]) -> Float64[np.ndarray, "n"]:
    return np.einsum("nd,nd->n", a, b)
