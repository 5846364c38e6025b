"""Hand-drawn lines made to close: overshoots trimmed, gaps bridged, double lines made one, what stays open dropped."""

from dataclasses import dataclass, field

import numpy as np

from texloom.sketch.bezier import lines as straight_curves
from texloom.sketch.cells import Cells, find_cells
from texloom.sketch.crossing import meetings
from texloom.sketch.reading.lines import Lines, joined, noded, tidy
from texloom.sketch.reading.mends import Mend, mends

# All in typical cells across.
WELD = 1e-3  # vertices nearer than that are one
_STEP = 0.04  # between places where a line may be met
_OVERSHOOT = 0.2  # the longest tail that is taken for a slip of the hand
_REACH = 0.4  # the widest gap that is closed
_TOUCH = 0.08  # a gap that is closed whatever the direction
_THIN = 0.08  # mean width of a face that is no cell but lies between two lines drawn for one
_SMALL = 0.15  # side of a square as large as the smallest cell
_SPOT = 0.3  # size of a face that shrinks to a point rather than loses a side
_AT_BORDER = 0.1  # where open ends are the drawing's own
_AHEAD = 0.25  # cosine of the widest turn from a line's end to what it is joined to
_ROUNDS = 6
_LEAST_CELL = 1e-3  # of the length drawn, where it covers no area


@dataclass
class Draft:
    """A drawing being mended."""

    lines: Lines
    size: np.ndarray
    cell: float = field(init=False)  # texels across a typical cell
    mends: list[Mend] = field(default_factory=list)

    def __post_init__(self) -> None:
        self.cell = typical_cell(self.lines)

    def open_ends(self) -> np.ndarray:
        """Vertices where a single line ends inside the drawing."""
        inside = np.minimum(self.lines.vertices + 0.5, self.size - 0.5 - self.lines.vertices).min(axis=1)
        return np.flatnonzero((self.lines.degree == 1) & (inside > _AT_BORDER * self.cell))


def typical_cell(lines: Lines) -> float:
    """Texels across a cell, from length by area: exact of squares and honeycombs, where every side serves two."""
    extent = np.ptp(lines.vertices, axis=0)
    length = float(lines.lengths.sum())
    return max(2 * float(extent.prod()) / max(length, 1e-9), _LEAST_CELL * length, 1e-6)


def mend(draft: Draft) -> None:
    """All mends in turn; afterwards every line bounds a cell or runs to the border."""
    _dense(draft)
    trim(draft)
    for _ in range(2):
        close(draft)
    prune(draft)
    thin(draft)
    prune(draft)


def cells_of(lines: Lines) -> Cells:
    """The cells of straight lines."""
    tail, head = lines.vertices[lines.edges].transpose(1, 0, 2)
    curve = straight_curves(np.zeros_like(tail), head - tail)[:, 1:]
    return find_cells(lines.vertices, lines.edges.astype(np.int32), curve)


def _dense(draft: Draft) -> None:
    """Vertices along long edges, so that there is somewhere to join."""
    vertices, edges = draft.lines.vertices, draft.lines.edges
    tail, head = vertices[edges].transpose(1, 0, 2)
    count = np.maximum(np.ceil(np.hypot(*(head - tail).T) / (_STEP * draft.cell)), 1).astype(np.int64)
    which = np.repeat(np.arange(len(edges)), count)
    place = np.arange(len(which)) - np.repeat(np.cumsum(count) - count, count)
    point = tail[which] + (place / count[which])[:, None] * (head - tail)[which]
    number = len(vertices) + np.arange(len(which))
    begin = np.where(place == 0, edges[which, 0], number)
    end = np.where(place == count[which] - 1, edges[which, 1], number + 1)
    draft.lines = tidy(np.concatenate([vertices, point]), np.stack([begin, end], axis=1))


def trim(draft: Draft) -> None:
    """Take off short tails beyond a fork."""
    for _ in range(_ROUNDS):
        lines, chains = draft.lines, draft.lines.chains
        tip = np.isin(chains.ends, draft.open_ends())
        forks = lines.degree[chains.ends[:, ::-1]] > 2
        tail = (tip & forks).any(axis=1) & (lines.lengths < _OVERSHOOT * draft.cell)
        if not tail.any():
            return
        where = np.where(tip[tail, 0], chains.ends[tail, 0], chains.ends[tail, 1])
        _say(draft, "trimmed an overshoot", lines.vertices[where], lines.lengths[tail])
        draft.lines = lines.of(~tail)


def _say(draft: Draft, did: str, places: np.ndarray, lengths: np.ndarray) -> None:
    """Note mends that can be seen."""
    seen = lengths > _STEP * draft.cell
    draft.mends += mends(did, places[seen], lengths[seen])


def close(draft: Draft) -> None:
    """Join open ends to what lies before them, or very near: other ends first. At the border only very near."""
    ends = np.flatnonzero(draft.lines.degree == 1)
    if not len(ends):
        return
    target, found = _targets(draft, ends)
    tip = draft.lines.vertices[ends[found]]
    ahead = target[found] - tip
    gap = np.hypot(*ahead.T)
    count = len(draft.lines.vertices)
    beyond = target[found] + ahead * (WELD * draft.cell / np.maximum(gap, 1e-12))[:, None]
    bridges = np.stack([ends[found], count + np.arange(len(gap))], axis=1)
    _say(draft, "closed a gap", tip + ahead / 2, gap)
    vertices = np.concatenate([draft.lines.vertices, beyond])
    draft.lines = noded(vertices, np.concatenate([draft.lines.edges, bridges]), weld=1.5 * WELD * draft.cell)
    trim(draft)


def _targets(draft: Draft, ends: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Where each open end is joined to, and whether there is such a place."""
    from scipy.spatial import KDTree

    lines, cell = draft.lines, draft.cell
    tip = lines.vertices[ends]
    chain, arc, toward = _along(lines, ends, _TOUCH * 2 * cell)
    tree = KDTree(lines.vertices)
    reach = np.where(np.isin(ends, draft.open_ends()), _REACH, _TOUCH) * cell
    near = tree.query_ball_point(tip, reach)
    whose = np.repeat(np.arange(len(ends)), [len(found) for found in near])
    at = np.concatenate([np.sort(np.array(found, np.int64)) for found in near])

    step = lines.vertices[at] - tip[whose]
    gap = np.hypot(*step.T)
    ahead = (step * toward[whose]).sum(axis=1) / np.maximum(gap, 1e-12)
    own = np.where(chain[at] == chain[ends[whose]], np.abs(arc[at] - arc[ends[whose]]), np.inf)
    allowed = (gap > 0) & (own > 3 * gap) & ((ahead > _AHEAD) | (gap < _TOUCH * cell))
    cost = gap * (2 - ahead) * np.where(np.isin(at, ends), 0.5, 1.0)
    cost[~allowed] = np.inf

    hit, distance = _straight_on(lines, ends, toward * reach[:, None])
    best, target = 0.9 * distance, hit
    order = np.lexsort((cost, whose))
    first = order[np.flatnonzero(np.diff(whose[order], prepend=-1))]
    nearer = cost[first] < best[whose[first]]
    target[whose[first][nearer]] = lines.vertices[at[first][nearer]]
    best[whose[first][nearer]] = cost[first][nearer]
    return target, np.isfinite(best)


def _along(lines: Lines, ends: np.ndarray, back: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The chain of each vertex and how far along it the vertex lies; where each open end points."""
    chains = lines.chains
    count = np.diff(chains.start)
    of = np.repeat(np.arange(len(count)), count)
    point = lines.vertices[chains.vertex]
    far = np.cumsum(np.hypot(*np.diff(point, axis=0, prepend=point[:1]).T))
    far -= np.repeat(far[chains.start[:-1]], count)
    chain, arc = np.full(len(lines.vertices), -1), np.zeros(len(lines.vertices))
    inner = lines.degree[chains.vertex] <= 2
    chain[chains.vertex[inner]], arc[chains.vertex[inner]] = of[inner], far[inner]

    toward = np.zeros((len(ends), 2))
    for i, end in enumerate(ends.tolist()):
        run = slice(chains.start[chain[end]], chains.start[chain[end] + 1])
        away = np.abs(far[run] - arc[end])
        toward[i] = lines.vertices[end] - point[run][np.where(away <= back, away, -1).argmax()]
    return chain, arc, toward / np.maximum(np.hypot(*toward.T), 1e-12)[:, None]


def _straight_on(lines: Lines, ends: np.ndarray, reach: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Where each end first meets a line if it goes on, and how far that is."""
    tip = lines.vertices[ends]
    count = len(lines.edges)
    start = np.concatenate([lines.vertices[lines.edges[:, 0]], tip + 1e-6 * reach])
    stop = np.concatenate([lines.vertices[lines.edges[:, 1]], tip + reach])
    met = meetings(start, stop)
    ray = (met.first < count) & (met.second >= count)
    share = np.ones(len(ends)) * np.inf
    np.minimum.at(share, met.second[ray] - count, met.on_second[ray])
    found = np.isfinite(share)
    hit = tip + np.where(found, share, 0)[:, None] * reach
    return hit, share * np.hypot(*reach.T)


def prune(draft: Draft) -> None:
    """Drop what ends nowhere, until nothing does."""
    while True:
        lines, ends = draft.lines, draft.open_ends()
        tip = np.isin(lines.chains.ends, ends)
        loose = np.any(tip, axis=1)
        if not loose.any():
            return
        where = np.where(tip[loose, 0], lines.chains.ends[loose, 0], lines.chains.ends[loose, 1])
        _say(draft, "dropped an open stroke", lines.vertices[where], lines.lengths[loose])
        draft.lines = lines.of(~loose)


def thin(draft: Draft) -> None:
    """Make faces that are too thin or small for cells vanish: small ones shrink to a point, long ones lose a side."""
    for _ in range(_ROUNDS):
        lines = draft.lines
        cells = cells_of(lines)
        if not len(cells):
            return
        tail, head = lines.vertices[lines.edges].transpose(1, 0, 2)
        length = np.hypot(*(head - tail).T)[cells.halfedge // 2]
        around = np.add.reduceat(length, cells.start[:-1])
        corner = lines.vertices[lines.edges.ravel()[cells.halfedge]]
        opens = cells.start[:-1]
        across = (np.maximum.reduceat(corner, opens) - np.minimum.reduceat(corner, opens)).max(axis=1)
        no_cell = (2 * cells.area < _THIN * draft.cell * around) | (cells.area < (_SMALL * draft.cell) ** 2)
        if not no_cell.any():
            return
        _shrink(draft, cells, no_cell & (across < _SPOT * draft.cell), no_cell & (across >= _SPOT * draft.cell))


def _shrink(draft: Draft, cells: Cells, spots: np.ndarray, slivers: np.ndarray) -> None:
    lines = draft.lines
    kept = np.ones(len(lines.chains), bool)
    chain = _chain_of_edge(lines)
    for cell in np.flatnonzero(slivers).tolist():
        sides = np.unique(chain[cells.halfedge[cells.start[cell] : cells.start[cell + 1]] // 2])
        if kept[sides].all():
            kept[sides[lines.lengths[sides].argmax()]] = False
    origin = lines.edges.ravel()[cells.halfedge]
    following = lines.edges.ravel()[cells.halfedge ^ 1]
    small = np.repeat(spots, np.diff(cells.start))
    group = joined(len(lines.vertices), np.stack([origin[small], following[small]], axis=1))
    edges = lines.edges[kept[chain]]
    count = np.bincount(group)
    mean = np.stack([np.bincount(group, lines.vertices[:, axis]) / count for axis in (0, 1)], axis=1)
    draft.lines = noded(mean, group[edges], weld=WELD * draft.cell)


def _chain_of_edge(lines: Lines) -> np.ndarray:
    """The chain each edge is part of."""
    chains, count = lines.chains, len(lines.vertices)
    of = np.repeat(np.arange(len(chains)), np.diff(chains.start))
    along = of[1:] == of[:-1]
    pair = np.sort(np.stack([chains.vertex[:-1][along], chains.vertex[1:][along]], axis=1), axis=1)
    key, own = pair[:, 0] * count + pair[:, 1], lines.edges.min(axis=1) * count + lines.edges.max(axis=1)
    order = np.argsort(key)
    return of[:-1][along][order[np.searchsorted(key[order], own)]]
