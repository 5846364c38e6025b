"""A flat surface scores as the picture it shows."""

import numpy as np
import pytest

from texloom.domain.patches import Patches
from texloom.errors import ParameterError
from texloom.metrics.score import score
from texloom.metrics.surface import chart_seam_ratio, read_pictures, score_surface


def _patches(shape: tuple[int, int], width: int, pitch: int, corners: int = 1) -> Patches:
    """Patches on a lattice that stay inside a picture of ``shape``; three corners name one site three times."""
    rows, columns = (np.arange(0, side - width + 1, pitch) for side in shape)
    first = (rows[:, None] * shape[1] + columns).reshape(-1, 1)
    offset = (np.arange(width)[:, None] * shape[1] + np.arange(width)).reshape(1, -1)
    sites = np.repeat((first + offset)[..., None], corners, axis=2).astype(np.int32)
    weights = None if corners == 1 else np.full(sites.shape, 1 / corners, np.float32)
    none = np.zeros(0, np.int32)
    return Patches(width, first[:, 0].astype(np.int32), sites, weights, none, none, np.zeros((0, 2), np.float32))


def _picture(seed: int, shape: tuple[int, ...]) -> np.ndarray:
    return np.random.default_rng(seed).random(shape, np.float32)


@pytest.mark.parametrize("corners", [1, 3])
def test_pictures_are_what_lies_under_the_patches(corners: int) -> None:
    picture = _picture(1, (20, 24, 3))
    pictures = read_pictures(_patches((20, 24), 8, 4, corners), picture.reshape(-1, 3))
    assert pictures.shape == (4 * 5, 8, 8, 3)
    np.testing.assert_allclose(pictures[6], picture[4:12, 4:12], rtol=1e-5)


def test_one_patch_over_everything_scores_as_the_plane() -> None:
    sample, picture = _picture(2, (32, 32, 1)), _picture(3, (32, 32, 1))
    surface = score_surface(sample, _patches((32, 32), 32, 32), picture.reshape(-1, 1))
    plane = score(sample, picture)
    np.testing.assert_allclose(surface.swd, plane.swd, rtol=1e-5)
    np.testing.assert_allclose(surface.coherence, plane.coherence, rtol=1e-4)
    np.testing.assert_allclose(surface.completeness, plane.completeness, rtol=1e-4)


def test_a_surface_that_shows_the_sample_is_perfect() -> None:
    sample = _picture(4, (24, 24, 3))
    scores = score_surface(sample, _patches((24, 24), 8, 1), sample.reshape(-1, 3))
    assert scores.coherence == pytest.approx(0.0, abs=1e-3) and scores.completeness == pytest.approx(0.0, abs=1e-3)
    assert scores.swd < 1.0  # patches overlap, so inner texels count more often


def test_cut_patches_are_left_out() -> None:
    patches = _patches((20, 20), 8, 4)
    patches.sites[3, 10] = -1
    assert len(read_pictures(patches, _picture(5, (400, 3)))) == patches.count - 1
    patches.sites[:, 10] = -1
    with pytest.raises(ParameterError, match="whole"):
        score_surface(_picture(6, (20, 20, 3)), patches, _picture(5, (400, 3)))


def test_narrow_patches_are_refused() -> None:
    with pytest.raises(ParameterError, match="7 samples"):
        score_surface(_picture(6, (20, 20, 3)), _patches((20, 20), 6, 4), _picture(5, (400, 3)))


def test_chart_seams_by_hand() -> None:
    values = np.array([[0.0], [0.1], [0.5], [0.6]], np.float32)
    edges = np.array([[0, 1], [2, 3]])
    assert chart_seam_ratio(values, edges, across=np.array([[1, 2]])) == pytest.approx(4.0, rel=1e-5)
    assert chart_seam_ratio(values, edges, across=np.array([[0, 1]])) == pytest.approx(1.0, rel=1e-5)
    assert chart_seam_ratio(values, edges, across=np.zeros((0, 2), int)) == 0.0
    assert chart_seam_ratio(np.zeros_like(values), edges, across=np.array([[1, 2]])) == 0.0


def test_what_may_not_be_used_of_a_sample_does_not_count() -> None:
    sample, shown = _picture(8, (24, 24, 3)), _picture(9, (24, 24, 3))
    beside = np.concatenate([sample, _picture(10, (24, 10, 3)) / 2], axis=1)
    usable = np.arange(34)[None].repeat(24, 0) < 24
    patches, values = _patches((24, 24), 12, 4), shown.reshape(-1, 3)
    alone, masked = score_surface(sample, patches, values), score_surface(beside, patches, values, usable=usable)
    assert vars(masked) == pytest.approx(vars(alone), rel=1e-5)
    with pytest.raises(ParameterError, match="no 7x7 patch of the sample is usable"):
        score_surface(beside, patches, values, usable=np.zeros_like(usable))
