"""Where a sweep closes on itself no seam shows.

A sweep has a front: what lies behind it is coloured, what lies ahead is not, and a site on it finds about half of its
surroundings there already. Where two fronts meet, or one closes around the last bare spot, a site finds nearly all of
them: it has to fit on every side at once, and misfits that sweeps push before them end up there. On a torus whose
field runs around the hole, fronts leave the start both ways and meet on a line at the far side; on a sphere they
close around a spot.

The seam ratio is the mean colour step along edges both ends of which found more than 0.6 of what lies within 2.5
texels of them before them, over that along all other edges; steps are per unit of length, as edges differ in it. What
chance leaves of a few hundred edges is averaged over two seeds, on a sample of small features. 1 is no seam.
"""

import numpy as np
import pytest
from numpy import ndarray

from tests.meshes import sphere, torus
from tests.synthesis.samples import blobs
from texloom.domain.order import sweep_order
from texloom.domain.surface import Surface
from texloom.exemplar.exemplar import from_array
from texloom.field.direction import from_vectors
from texloom.mesh.mesh import Mesh
from texloom.output.gather import gather_sites
from texloom.synthesis.sweep import Shape, Sweep
from texloom.synthesis.synthesize import synthesize

SAMPLE = from_array(np.ascontiguousarray(blobs(128)[::2, ::2]))
MESHES = {"torus": torus(48, 24), "sphere": sphere(4)}
AROUND = np.array([0.0, 0.0, 1.0])


def swept_around(mesh: Mesh) -> Surface:
    """About two thousand texels of a field that runs around and around, without a start."""
    texel = float(np.sqrt(mesh.face_areas.sum() / 2000))
    return Surface.build(mesh, from_vectors(mesh, 1, np.cross(AROUND, mesh.vertices)), texel=texel)


def enclosed(surface: Surface) -> ndarray:
    """The sites that found their surroundings there already."""
    rank = np.empty(surface.count, np.int64)
    rank[sweep_order(surface)] = np.arange(surface.count)
    sites = surface.neighbourhoods(np.arange(surface.count, dtype=np.int32), 2).sites[:, 1:]
    before = (sites >= 0) & (rank[sites] < rank[:, None])
    return before.sum(axis=1) > 0.6 * (sites >= 0).sum(axis=1)


def seam_ratio(surface: Surface, shown: list[ndarray]) -> float:
    """Over several pictures of the surface."""
    seam = enclosed(surface)[surface.edges].all(axis=1)
    assert 0.005 < seam.mean() < 0.2
    low, high = surface.edges.T
    step = sum(np.abs(values[low] - values[high]).mean(axis=1) for values in shown) / surface.refined.mesh.edge_lengths
    return float(step[seam].mean() / step[~seam].mean())


@pytest.mark.parametrize("name", MESHES)
@pytest.mark.parametrize("shape", ["causal", "half"])
def test_no_seam_shows_where_the_sweep_closes(name: str, shape: Shape) -> None:
    surface = swept_around(MESHES[name])
    method = Sweep(start="random", shape=shape, order="sequential")
    made = [synthesize(SAMPLE, surface, method, seed=seed).sources for seed in range(2)]
    assert seam_ratio(surface, [gather_sites(sources, SAMPLE.lead) for sources in made]) <= 1.2


@pytest.mark.parametrize("name", MESHES)
def test_a_seam_would_show(name: str) -> None:
    """Texels that do not fit where the sweep closes, in a picture that is smooth elsewhere, are told by the ratio."""
    surface, image = swept_around(MESHES[name]), SAMPLE.lead.image
    row, column = 32 + np.rint(10 * surface.refined.mesh.vertices[:, :2].T).astype(int)
    values = image[row, column]
    smooth, odd = seam_ratio(surface, [values]), enclosed(surface)
    values[odd] = image.reshape(-1, 3)[np.random.default_rng(0).integers(0, 64 * 64, odd.sum())]
    assert seam_ratio(surface, [values]) > max(1.2, 1.4 * smooth)
