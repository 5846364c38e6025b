"""Even points: the coarsest chosen from the mesh, each finer level from the one before, all by repulsion.

The start is even already (short edges of a fine mesh collapsed; middles of a coarse level's edges), so a few dozen
steps do. What they leave wrong, points too near and edges too long, is taken out and put in elsewhere.
"""

import numpy as np

from texloom.errors import ParameterError
from texloom.points.corners import corners
from texloom.points.crowding import crowded, upturned
from texloom.points.ground import Ground
from texloom.points.places import Places
from texloom.points.start import start
from texloom.points.tiling import Tiling

_FINE = 0.6  # spacings: edges of the mesh that points are chosen from
_BEND = 0.5  # spacings that opposite normals put two points apart, half of them
_APART = (0.3, 0.5, 0.65, 0.8)  # spacings: edges shorter than that are collapsed, in this order
_STEPS = 60  # of repulsion from a start, and the most ever
_FEWEST_STEPS, _ALL_STEPS = 12, 1_000_000  # of repulsion after a level is refined: each point's, and in all
_NEAR, _FAR = 0.56, 1.6  # spacings: edges beyond are wrong
_ROUNDS = 8  # of putting them right
_LOCAL_STEPS, _RINGS = 8, 3  # of repulsion after that, and how far around it goes
_HOPELESS = 0.002  # of the points: with more wrong than that, and no fewer than a round before, it is the mesh
_COVERED = 1.25  # spacings: a vertex of the mesh that far from all points was left out
_LEAST_START = 4000  # points: fewer are laid at once, more by way of a quarter of them
_FULL = 0.75  # of the points that splitting all edges gives: with so many wanted, all are split
_ANCHORED = 32_000  # points: beyond, edges that are wrong are left; beyond that and two a vertex, so are bare parts


def lay(ground: Ground, count: int, *, seed: int) -> Tiling:
    """So many points on the mesh, spread evenly; those in corners of its boundary come first and stay."""
    if count < 4 * _LEAST_START:
        return _laid(ground, count, seed=seed, kept=corners(ground, count))
    coarse = lay(ground, count // 4, seed=seed)
    return _finer(coarse, count, seed=seed, frozen=coarse.frozen)


def refined(tiling: Tiling, count: int, *, seed: int) -> Tiling:
    """So many points, the given ones among them: first and in their places.

    New points begin in the middles of edges. Where the coarse triangulation is too coarse to follow the mesh, and
    points get stuck or leave parts of it bare, the new ones are chosen from the mesh again.
    """
    ground = tiling.ground
    spacing = ground.spacing(count)
    finer = _finer(tiling, count, seed=seed, frozen=tiling.count)
    faults = bare, wrong = _faults(finer, spacing)
    limit = _ANCHORED + (2 * len(ground.vertices) if bare else 0)
    if bare + wrong == 0 or count > limit:
        return finer
    anchored = _laid(ground, count, seed=seed, kept=tiling.places)
    return anchored if _faults(anchored, spacing) < faults else finer


def _laid(ground: Ground, count: int, *, seed: int, kept: Places) -> Tiling:
    """Points chosen from the mesh at once; those that are kept come first and stay."""
    spacing = ground.spacing(count)
    tiling = start(ground, _FINE * spacing, bend=_BEND * spacing, kept=kept)
    tiling.flip()
    for part in _APART:
        while tiling.thin_out(part * spacing, most=max(tiling.count - count, 0), seed=seed, shortest_first=False):
            pass
    _adjust(tiling, count, seed=seed)
    tiling.spread(spacing, _STEPS)
    _even_out(tiling, spacing, seed=seed)
    return tiling


def _finer(tiling: Tiling, count: int, *, seed: int, frozen: int) -> Tiling:
    """More points, the new ones from the middles of edges; the first ``frozen`` stay."""
    spacing = tiling.ground.spacing(count)
    tiling = tiling.copy(bend=_BEND * spacing, frozen=frozen)
    if count >= _FULL * (tiling.count + tiling.edge_count):
        tiling.quarter()
    tiling.flip()
    tiling.take_out(upturned(tiling))
    _adjust(tiling, count, seed=seed)
    tiling.flip()
    tiling.spread(spacing, min(max(_ALL_STEPS // count, _FEWEST_STEPS), _STEPS))
    _even_out(tiling, spacing, seed=seed)
    return tiling


def _adjust(tiling: Tiling, count: int, *, seed: int, careful: bool = False) -> None:
    """Take out points at the shortest edges, or put some on the longest, until there are ``count``."""
    gently = True
    while tiling.count > count:
        most = max(1, min(tiling.count - count, tiling.count // 20))
        gone = tiling.thin_out(np.inf, most=most, seed=seed, shortest_first=True, careful=gently)
        if gone == 0 and not gently:
            raise ParameterError(
                f"{count} points are too few for the parts, holes and handles of this mesh, which take {tiling.count} "
                "or a little fewer: ask for more"
            )
        gently = gently and 4 * gone >= most
    while tiling.count < count:
        put = tiling.fill_in(max(1, min(count - tiling.count, tiling.count // 8)), careful=careful)
        if put == 0 and not careful:
            raise ParameterError(f"no room for {count} points on this mesh, {tiling.count} fill it: ask for fewer")
        careful = careful and put > 0


def _even_out(tiling: Tiling, spacing: float, *, seed: int) -> None:
    """Take points from where they are too near each other to where they are too far, and let all settle.

    Where that does not help, because edges cut a ridge and their middles end up beside other points, points that are
    too near go elsewhere, and the edges stay long. So do points of faces that lie upside down.
    """
    count, before = tiling.count, np.inf
    for turn in range(_ROUNDS):
        careful = turn >= _ROUNDS // 2
        near, far = _wrong(tiling, spacing)
        wrong = near if careful else max(near, far)
        if wrong == 0 or (wrong >= before and wrong > count * _HOPELESS):
            break
        before = wrong
        tiling.thin_out((_NEAR + 0.25) * spacing, most=wrong, seed=seed, shortest_first=True, careful=False)
        _fill(tiling, count, spacing, seed=seed, careful=careful)
    for _ in range(_ROUNDS):
        astray = np.union1d(crowded(tiling, _NEAR * spacing), upturned(tiling))
        if len(astray) == 0:
            break
        tiling.take_out(astray)
        _fill(tiling, count, spacing, seed=seed, careful=True)


def _fill(tiling: Tiling, count: int, spacing: float, *, seed: int, careful: bool) -> None:
    """Put in what is missing, and let it and what is wrong settle."""
    rest = tiling.count
    _adjust(tiling, count, seed=seed, careful=careful)
    tiling.spread(spacing, _LOCAL_STEPS, _unsettled(tiling, rest, spacing))


def _unsettled(tiling: Tiling, rest: int, spacing: float) -> np.ndarray:
    """Points from number ``rest`` on, ends of edges that are wrong or nearly, and what is near them."""
    halfedges, lengths = tiling.edges()
    odd = halfedges[(lengths < _NEAR * 1.25 * spacing) | (lengths > _FAR * 0.9 * spacing)]
    return tiling.around(np.concatenate([*tiling.ends(odd), np.arange(rest, tiling.count)]), _RINGS)


def _wrong(tiling: Tiling, spacing: float) -> tuple[int, int]:
    """How many edges are too short, and how many too long."""
    lengths = tiling.edges()[1]
    return int((lengths < _NEAR * spacing).sum()), int((lengths > _FAR * spacing).sum())


def _faults(tiling: Tiling, spacing: float) -> tuple[int, int]:
    """Vertices of the mesh that no point is near, and edges that are wrong."""
    from scipy.spatial import KDTree

    ground = tiling.ground
    apart, _ = KDTree(tiling.places.at).query(ground.vertices[ground.used])
    bare = apart > _COVERED * spacing * ground.scale[ground.used]
    return int(bare.sum()), max(_wrong(tiling, spacing))
