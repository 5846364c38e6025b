"""Elements drawn over one another, such as leaves: told by lines that curve round and run on through each other."""

import numpy as np
from jaxtyping import Float64

from texloom.errors import FileError
from texloom.sketch.crossing import cross
from texloom.sketch.reading.labels import drawn_together
from texloom.sketch.reading.lines import Lines
from texloom.sketch.reading.mending import typical_cell

_STRAIGHT = 0.6  # radians: the most a line turns where it crosses another
_BACK = 4  # a quarter of the way to the next fork a line shows where it comes from
_CROSSING = 0.3  # typical cells between forks that may be one crossing, drawn thick
_ROUND = 0.5  # turns: a line that curves less is no part of an outline
_SHARE = 0.12  # of the cells: as many outlines that cross others make a texture of overlapping elements
_FEWEST = 3.0


def refuse_overlap(lines: Lines, cells: int) -> None:
    """Nothing, where cells lie beside each other.

    Raises: FileError, if outlines of elements cross each other too often for cells.
    """
    thick = lines.collapsed(drawn_together(lines, _CROSSING * typical_cell(lines)))
    count = max(crossing_outlines(lines), crossing_outlines(thick))
    if count >= max(_FEWEST, _SHARE * cells):
        raise FileError(
            f"the drawing's elements overlap (about {count:.0f} outlines run through others), and a cell holds one "
            "element: such textures are for --method refine or optimize"
        )


def crossing_outlines(lines: Lines) -> float:
    """Whole turns made by lines that go straight on through crossings: 1 for an outline that crosses others.

    Lines that turn less than half round between where they begin and end do not count: a grid has crossings, too.
    """
    follow = _straight_on(lines)
    turns = _turns(lines)
    led = np.zeros(len(follow), bool)
    led[follow[follow >= 0]] = True
    after, seen, outlines = follow.tolist(), [False] * len(follow), 0.0
    for first in np.argsort(led, kind="stable").tolist():
        at, turned, crossings = first, 0.0, -1
        while at >= 0 and not seen[at]:
            seen[at] = seen[at ^ 1] = True
            turned += turns[at // 2] * (1 - 2 * (at % 2))
            at, crossings = after[at], crossings + 1
        if crossings > 0 and abs(turned) > _ROUND:
            outlines += abs(turned)
    return outlines


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


def _straight_on(lines: Lines) -> np.ndarray:
    """The half-chain (2 c along chain c, 2 c + 1 against it) on which each goes on through a crossing of two lines."""
    chains = lines.chains
    starts, stops = chains.start[:-1], chains.start[1:] - 1
    back = np.maximum((stops - starts) // _BACK, 1)
    point = lines.vertices[chains.vertex]
    leaving = np.stack([point[starts + back] - point[starts], point[stops - back] - point[stops]], axis=1).reshape(
        -1, 2
    )
    angle = np.arctan2(leaving[:, 1], leaving[:, 0])
    origin = chains.ends.ravel()
    order = np.lexsort((angle, origin))
    crossing = np.bincount(origin, minlength=len(lines.vertices)) == 4
    at = order[crossing[origin[order]]].reshape(-1, 4)

    def bent(one: int, other: int) -> np.ndarray:
        return np.abs((angle[at[:, one]] - angle[at[:, other]]) % (2 * np.pi) - np.pi)

    at = at[(bent(0, 2) < _STRAIGHT) & (bent(1, 3) < _STRAIGHT)]
    follow = np.full(len(origin), -1)
    for one, other in ((0, 2), (1, 3)):
        follow[at[:, one] ^ 1], follow[at[:, other] ^ 1] = at[:, other], at[:, one]
    return follow
