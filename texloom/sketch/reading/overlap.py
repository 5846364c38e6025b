"""Elements drawn over one another, such as leaves: told by lines that curve round and run on through each other."""

import numpy as np
from jaxtyping import Bool, Float64

from texloom.errors import FileError
from texloom.sketch.crossing import cross
from texloom.sketch.reading.labels import borders, drawn_together
from texloom.sketch.reading.lines import Lines
from texloom.sketch.reading.mending import typical_cell

_STRAIGHT = 0.6  # radians: the most a line turns where it crosses another
_BACK = 4  # a quarter of the way to the next fork a line shows where it comes from
_CROSSING = 0.3  # typical cells between forks that may be one crossing, drawn thick
_ROUND = 0.5  # turns: a line that curves less is no part of an outline
_SHARE = 0.12  # of the cells: as many outlines that cross others make a texture of overlapping elements
_FEWEST = 3.0

# Of pictures; lengths in widths of the ink.
_INK_CROSSING = 2.0  # between forks that are one crossing
_BLURRED = 1.0  # from a crossing: there its middle bends the lines
_SHOWN = 8.0  # from a crossing: so far a line's direction and bend are measured, or to half way
_GRAIN = 1.5  # texels: the least radius of a piece of paper
_INK_ROUND = 0.25  # turns: outlines break where crossings are too blurred to follow
_INK_SHARE = 0.06  # of the cells, as crossings that are blurred or at a narrow angle are not found
_INK_FEWEST = 2.5


def refuse_overlap(lines: Lines, cells: int) -> None:
    """Nothing, where cells lie beside each other.

    Raises: FileError, if outlines of elements cross each other too often for cells.
    """
    thick = lines.collapsed(drawn_together(lines, _CROSSING * typical_cell(lines)))
    count = max(crossing_outlines(some, _towards(some), least=_ROUND) for some in (lines, thick))
    _refuse(count, enough=max(_FEWEST, _SHARE * cells))


def refuse_inked_overlap(ink: Bool[np.ndarray, "row column"], cells: int) -> None:
    """The same of a picture, by its lines as inked: those mended for cells no longer cross as they were drawn.

    Raises: FileError, if outlines of elements cross each other too often for cells.
    """
    lines, width = _inked(ink)
    count = crossing_outlines(lines, _tangents(lines, width), least=_INK_ROUND)
    _refuse(count, enough=max(_INK_FEWEST, _INK_SHARE * cells))


def _refuse(count: float, *, enough: float) -> None:
    if count >= enough:
        raise FileError(
            f"the drawing's elements overlap (about {count:.0f} outlines run through others), and a cell holds one "
            "element: such textures are for --method refine or optimize"
        )


def crossing_outlines(lines: Lines, angle: Float64[np.ndarray, "half_chain"], *, least: float) -> float:
    """Whole turns made by outlines that go straight on through others: 1 for a closed one.

    Outlines turn by ``least`` between where they begin and end; a grid has crossings, too. ``angle`` is the direction,
    in radians, in which each half-chain leaves its vertex: 2 c along chain c, 2 c + 1 against it.
    """
    follow = _straight_on(lines, angle)
    run, turned = _runs(follow, _turns(lines))
    outline = np.abs(turned) > least
    through = np.flatnonzero(follow >= 0)
    vertex, run = lines.chains.ends.ravel()[through ^ 1], run[through // 2]
    of_outlines = np.ones(len(lines.vertices), bool)
    np.logical_and.at(of_outlines, vertex, outline[run])
    return float(np.abs(turned[np.unique(run[of_outlines[vertex]])]).sum())


def _runs(follow: np.ndarray, turns: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The number of the run of each chain, chains that go straight on making one, and the turns of each run."""
    led = np.zeros(len(follow), bool)
    led[follow[follow >= 0]] = True
    after, of, turned = follow.tolist(), [-1] * len(turns), []
    for first in np.argsort(led, kind="stable").tolist():
        if of[first // 2] >= 0:
            continue
        at, total = first, 0.0
        while at >= 0 and of[at // 2] < 0:
            of[at // 2] = len(turned)
            total += turns[at // 2] * (1 - 2 * (at % 2))
            at = after[at]
        turned.append(total)
    return np.array(of, np.int64), np.array(turned)


def _turns(lines: Lines) -> Float64[np.ndarray, "chain"]:
    """Whole turns of each chain from end to end, counter-clockwise positive."""
    chains = lines.chains
    if not len(chains):
        return np.zeros(0)
    step = np.diff(lines.vertices[chains.vertex], axis=0, append=0.0)
    turn = np.arctan2(cross(step[:-1], step[1:]), (step[:-1] * step[1:]).sum(axis=1))
    of = np.repeat(np.arange(len(chains)), np.diff(chains.start))
    inner = (of[:-1] == of[1:]) & (np.append(of[2:], -1) == of[:-1])
    return np.bincount(of[:-1][inner], turn[inner], len(chains)) / (2 * np.pi)


def _towards(lines: Lines) -> Float64[np.ndarray, "half_chain"]:
    """The direction from each half-chain's vertex to a quarter of its way, in radians."""
    chains = lines.chains
    starts, stops = chains.start[:-1], chains.start[1:] - 1
    back = np.maximum((stops - starts) // _BACK, 1)
    point = lines.vertices[chains.vertex]
    leaving = np.stack([point[starts + back] - point[starts], point[stops - back] - point[stops]], axis=1)
    return _angle(leaving).ravel()


def _tangents(lines: Lines, width: float) -> Float64[np.ndarray, "half_chain"]:
    """The direction of each half-chain at its vertex, in radians: of the arc along it, beyond what the ink blurs.

    Two chords as long as each other show the arc's direction and bend, which lead back to the vertex.
    """
    chains = lines.chains
    if not len(chains):
        return np.zeros(0)
    point = lines.vertices[chains.vertex]
    step = np.hypot(*np.diff(point, axis=0, prepend=point[:1]).T)
    along = np.cumsum(step)
    opens, closes = along[chains.start[:-1]], along[chains.start[1:] - 1]
    far = np.minimum(_SHOWN * width, (closes - opens) / 2)
    near = np.minimum(_BLURRED * width, far / 4)

    def chord(origin: np.ndarray, begin: np.ndarray, end: np.ndarray) -> np.ndarray:
        ends = [[np.interp(origin + at, along, axis) for axis in point.T] for at in (begin, end)]
        return _angle((np.array(ends[1]) - np.array(ends[0])).T)

    angles = []
    for origin, way in ((opens, 1), (closes, -1)):
        first = chord(origin, way * near, way * (near + far) / 2)
        bend = _within_half(chord(origin, way * (near + far) / 2, way * far) - first)
        angles.append(first - bend * (0.5 + 2 * near / (far - near)))
    return np.stack(angles, axis=1).ravel()


def _straight_on(lines: Lines, angle: Float64[np.ndarray, "half_chain"]) -> np.ndarray:
    """The half-chain on which each goes on through a crossing of two lines."""
    angle = angle % (2 * np.pi)
    origin = lines.chains.ends.ravel()
    order = np.lexsort((angle, origin))
    crossing = np.bincount(origin, minlength=len(lines.vertices)) == 4
    at = order[crossing[origin[order]]].reshape(-1, 4)

    def bent(one: int, other: int) -> np.ndarray:
        return np.abs(_within_half(angle[at[:, one]] - angle[at[:, other]] - np.pi))

    at = at[(bent(0, 2) < _STRAIGHT) & (bent(1, 3) < _STRAIGHT)]
    follow = np.full(len(origin), -1)
    for one, other in ((0, 2), (1, 3)):
        follow[at[:, one] ^ 1], follow[at[:, other] ^ 1] = at[:, other], at[:, one]
    return follow


def _angle(vector: Float64[np.ndarray, "*some 2"]) -> Float64[np.ndarray, "*some"]:
    return np.arctan2(vector[..., 1], vector[..., 0])


def _within_half(angle: np.ndarray) -> np.ndarray:
    """The same angle between half a turn back and half a turn on."""
    return (angle + np.pi) % (2 * np.pi) - np.pi


def _inked(ink: Bool[np.ndarray, "row column"]) -> tuple[Lines, float]:
    """Lines along the middle of ink that parts two pieces of paper, nothing mended, and the width of the ink."""
    from scipy.ndimage import distance_transform_edt, label

    piece = np.zeros(ink.shape, np.int32)
    count = int(label(~ink, output=piece))  # pyright: ignore[reportArgumentType]
    width = 4 * float(np.asarray(distance_transform_edt(ink))[ink].mean()) - 2
    radius = np.zeros(count + 1)
    np.maximum.at(radius, piece.ravel(), np.asarray(distance_transform_edt(~ink)).ravel())
    paper = (radius >= max(width / 2, _GRAIN))[piece] & ~ink  # less is a flaw of the ink
    row, column = np.asarray(distance_transform_edt(~paper, return_distances=False, return_indices=True))
    return borders(piece[row, column], shortest=_INK_CROSSING * width), width
