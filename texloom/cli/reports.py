"""What ``--report`` tells of a run: the sample, the result, where it came from, scores, times and settings."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float32

from texloom.cli.bring_home import Grown, picture
from texloom.cli.painted import score_sites, scored_patches
from texloom.cli.score import as_seen
from texloom.domain.grid import Grid
from texloom.domain.surface import Surface
from texloom.errors import ParameterError
from texloom.exemplar.exemplar import Exemplar, Map, to_map
from texloom.metrics import score
from texloom.output.debug import broken_edges, grid_edges, source_colours, with_borders
from texloom.output.gather import gather_sites, identity_sources
from texloom.output.image import encoded_picture, stored
from texloom.output.plots import line_plot
from texloom.output.preview import Skin
from texloom.output.report import Account, Figure, fitted
from texloom.synthesis.result import Result

LARGE, _SMALL = 1024, 384  # pixels, the longest side of the main pictures and of the others
_COMPARED = 65_536  # patches of a picture, those of 256×256 texels: more take long and hardly change the scores
_COLOURS = "Where each texel of the sample lies, as a colour"
_ORIGIN = "Where in the sample each texel comes from; red where copied pieces meet"


@dataclass(frozen=True, eq=False)
class Run:
    """What every command knows at its end."""

    exemplar: Exemplar
    result: Result
    settings: Mapping[str, str]
    seconds: Mapping[str, float]
    command: str


def of_image(run: Run, grid: Grid, maps: Mapping[str, Map]) -> Account:
    """The account of ``texloom image``."""
    name, *others = maps
    theirs, ours = run.exemplar.maps[name], maps[name]
    figures = {
        "Sample": sample_figures(run.exemplar),
        "Result": [Figure(fitted(stored(ours, 8), LARGE), f"{name}, {grid.columns}×{grid.rows} texels")],
        "Its other maps": [Figure(fitted(stored(maps[other], 8), _SMALL), other) for other in others],
        "Origin": [
            Figure(fitted(_origin(run, grid), LARGE), _ORIGIN),
            Figure(fitted(_legend(run.exemplar), LARGE), _COLOURS),
        ],
    }
    try:
        scores, remark = (
            vars(score(as_seen(theirs), as_seen(ours), usable=run.exemplar.mask, most=_COMPARED)),
            f"Of {name}, against the sample; 0 is best, but for copy.",
        )
    except ParameterError as error:
        scores, remark = {}, f"No scores: {error}."
    return _account(run, "Image", figures, scores, remark)


def of_surface(run: Run, grown: Grown, skin: Skin) -> Account:
    """The account of ``texloom surface``."""
    name = next(iter(run.exemplar.maps))
    sites = f"{grown.surface.count} sites, a texel is {grown.surface.texel:.4g} long"
    origin = Skin(colours=_site_origin(run, grown.surface), gloss=0.0)
    figures = {
        "Sample": sample_figures(run.exemplar),
        "Result": [Figure(fitted(picture(grown, skin), LARGE), f"{grown.model.path.name} from four sides, {sites}")],
        "Origin": [
            Figure(fitted(picture(grown, origin), LARGE), _ORIGIN),
            Figure(fitted(_legend(run.exemplar), LARGE), _COLOURS),
        ],
    }
    map = run.exemplar.maps[name]
    try:
        values = gather_sites(run.result.sources, map)
        scores = vars(score_sites(map, scored_patches(grown.surface), values, usable=run.exemplar.mask, most=_COMPARED))
        remark = f"Of {name}, on pictures laid along the field, against the sample; 0 is best."
    except ParameterError as error:
        scores, remark = {}, f"No scores: {error}."
    return _account(run, "Surface", figures, scores, remark)


def _account(
    run: Run, what: str, figures: Mapping[str, list[Figure]], scores: Mapping[str, float], remark: str
) -> Account:
    return Account(
        title=f"{what} from {run.settings['sample']}",
        subtitle=f"{run.settings['software']}, seed {run.settings['seed']}",
        command=run.command,
        settings=run.settings,
        figures=figures,
        scores=scores,
        remark=remark,
        energy=run.result.energy,
        plots={name: line_plot(values, across="pass") for name, values in run.result.curves.items() if values},
        seconds=run.seconds,
    )


def sample_figures(exemplar: Exemplar) -> list[Figure]:
    """Every map, and which texels were imitated where not all were."""
    rows, columns = exemplar.shape
    figures = [Figure(fitted(stored(map, 8), _SMALL), name) for name, map in exemplar.maps.items()]
    figures[0] = Figure(figures[0].picture, f"{figures[0].caption}, {columns}×{rows} texels")
    if exemplar.mask is not None:
        share = 100 * float(exemplar.mask.mean())
        figures.append(
            Figure(fitted(stored(to_map(exemplar.mask[..., None], "data"), 8), _SMALL), f"{share:.0f} % used")
        )
    return figures


def _legend(exemplar: Exemplar) -> np.ndarray:
    """The sample in the colours of places."""
    identity = identity_sources(*exemplar.shape)
    return encoded_picture(source_colours(identity, exemplar.shape).reshape(*exemplar.shape, 3))


def _origin(run: Run, grid: Grid) -> np.ndarray:
    """Places of an image's sources, and where copied pieces meet."""
    colours = source_colours(run.result.sources, run.exemplar.shape)
    edges, offsets = grid_edges(grid.rows, grid.columns)
    broken = broken_edges(run.result.sources, edges, _along_field(grid, edges[:, 0], offsets))
    return encoded_picture(with_borders(colours, edges, broken).reshape(grid.rows, grid.columns, 3))


def _along_field(
    grid: Grid, sites: np.ndarray, offsets: Float32[np.ndarray, "edge 2"]
) -> Float32[np.ndarray, "edge 2"]:
    """Offsets in the image's frame, in the frames of the sites and in their texels."""
    if grid.field is None:
        return offsets
    along = grid.field.reshape(-1, 2)[sites]
    along = along / np.linalg.norm(along, axis=1, keepdims=True)
    down = np.stack([along[:, 1], -along[:, 0]], axis=1)  # +row: a quarter turn clockwise from +column
    turned = np.stack([(offsets * down).sum(1), (offsets * along).sum(1)], axis=1)
    length = 1.0 if grid.magnitude is None else grid.magnitude.reshape(-1, 1)[sites]
    return (turned / length).astype(np.float32)


def _site_origin(run: Run, surface: Surface) -> Float32[np.ndarray, "site 3"]:
    """Places of a surface's sources, and where copied pieces meet."""
    one, other = surface.edges.T
    step = surface.refined.mesh.vertices[other] - surface.refined.mesh.vertices[one]
    direction, normal = surface.direction[one], surface.normal[one]
    across = np.einsum("ed,ed->e", step, direction)
    up = np.einsum("ed,ed->e", step, np.cross(normal, direction))
    offsets = np.stack([-up, across], axis=1) / surface.texel_length[one, None]
    colours = source_colours(run.result.sources, run.exemplar.shape)
    return with_borders(colours, surface.edges, broken_edges(run.result.sources, surface.edges, offsets))
