import numpy as np
import pytest

from texloom.demo.samples import SAMPLES, draw
from texloom.errors import ParameterError


@pytest.mark.parametrize("name", SAMPLES)
def test_a_sample_is_a_lively_aligned_stack(name: str) -> None:
    stack = draw(name, size=64, seed=1)
    assert stack.shape == (64, 64)
    for map in stack.maps.values():
        assert map.image.dtype == np.float32 and 0.0 <= map.image.min() and map.image.max() <= 1.0
    assert stack.maps["basecolor"].image.std() > 0.02
    # The normal map is that of the height map: they slope the same way
    height = stack.maps["height"].image[..., 0]
    rise = -np.gradient(height, axis=1)
    tilt = stack.maps["normal"].image[..., 0] - 0.5
    assert np.corrcoef(rise.ravel(), tilt.ravel())[0, 1] > 0.7


def test_same_seed_same_pixels() -> None:
    first, again, other = (draw("weave", size=48, seed=seed).maps["basecolor"].image for seed in (3, 3, 4))
    np.testing.assert_array_equal(first, again)
    assert np.abs(first - other).max() > 0.1


def test_an_unknown_sample_lists_the_others() -> None:
    with pytest.raises(ParameterError, match="unknown sample 'moss': choose one of bricks, knit"):
        draw("moss")
