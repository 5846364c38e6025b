"""A vocabulary of textons: labels, buckets and distances agree with each other and with their definitions."""

import numpy as np
import pytest

from texloom.errors import ExemplarError, ParameterError
from texloom.exemplar.exemplar import Exemplar, from_array, to_map
from texloom.kernels.launch import use
from texloom.search.textons import Textons, learn_textons

RNG = np.random.default_rng(21)


def noise(rows: int, columns: int, channels: int = 3) -> np.ndarray:
    """Smooth noise, so that neighbouring windows are alike."""
    from scipy.ndimage import gaussian_filter

    values = gaussian_filter(RNG.random((rows, columns, channels)), (1.5, 1.5, 0))
    return np.rint(255 * (values - values.min()) / np.ptp(values)).astype(np.uint8)


def windows_of(textons: Textons) -> np.ndarray:
    """The whole weighted window of every texel."""
    width = textons.settings.width
    reach = width // 2
    padded = np.pad(textons.image, ((reach, reach), (reach, reach), (0, 0)), mode="symmetric")
    windows = np.lib.stride_tricks.sliding_window_view(padded, (width, width), axis=(0, 1))
    offset = np.arange(-reach, reach + 1)
    weight = np.exp(-0.5 * (offset[:, None] ** 2 + offset**2) / (0.25 * width) ** 2)
    return (windows * np.sqrt(weight / weight.sum())).reshape(textons.labels[0].size, -1)


def test_the_vocabulary_is_as_large_as_the_paper_says():
    textons = learn_textons(from_array(noise(40, 50)), orientations=3)
    assert textons.count == 45 == len(textons.distance)
    assert textons.labels.shape == (3, 40, 50) and set(textons.labels[0].ravel()) == set(range(45))
    assert 0.99 <= textons.kept <= 1.0 and 1 <= textons.passes < 100
    assert learn_textons(from_array(noise(40, 50)), count=12, orientations=1).count == 12


def test_buckets_hold_every_texel_by_its_texton():
    mask = RNG.random((30, 34)) < 0.7
    textons = learn_textons(from_array(noise(30, 34), mask=mask), orientations=2)
    assert (textons.labels[:, mask] >= 0).all() and (textons.labels[:, ~mask] == -1).all()
    assert textons.bucket.dtype == textons.bucket_start.dtype == np.int32
    np.testing.assert_array_equal(np.sort(textons.bucket), np.flatnonzero(mask))
    assert len(textons.bucket_start) == textons.count + 1 and textons.bucket_start[-1] == mask.sum()
    for k in range(textons.count):
        held = textons.bucket[textons.bucket_start[k] : textons.bucket_start[k + 1]]
        np.testing.assert_array_equal(held, np.flatnonzero(textons.labels[0].ravel() == k))
        assert len(held)


def test_distances_are_those_of_mean_windows():
    textons = learn_textons(from_array(noise(64, 64)), orientations=1)
    np.testing.assert_array_equal(textons.distance, textons.distance.T)
    assert (np.diag(textons.distance) == 0).all()
    windows, label = windows_of(textons), textons.labels[0].ravel()
    centres = np.stack([windows[label == k].mean(axis=0) for k in range(textons.count)])
    expected = ((centres[:, None] - centres) ** 2).sum(2)
    np.testing.assert_allclose(textons.distance, expected, rtol=0.1, atol=0.02 * expected.mean())


def test_texels_of_one_texton_look_alike():
    textons = learn_textons(from_array(noise(64, 64)), orientations=1)
    windows, label = windows_of(textons), textons.labels[0].ravel()
    other = textons.bucket[
        textons.bucket_start[label] + RNG.integers(0, 1 << 30, label.size) % np.bincount(label)[label]
    ]
    alike = ((windows - windows[other]) ** 2).sum(1).mean()
    apart = ((windows - windows[RNG.permutation(label.size)]) ** 2).sum(1).mean()
    assert alike < 0.6 * apart


def test_equal_surroundings_have_equal_labels_at_every_turn():
    tile = RNG.integers(0, 256, (8, 8, 3), dtype=np.uint8)
    textons = learn_textons(from_array(np.tile(tile, (8, 9, 1))), orientations=5)
    inside = textons.labels[:, 8:-8, 8:-8]
    np.testing.assert_array_equal(inside[:, 8:], inside[:, :-8])
    np.testing.assert_array_equal(inside[:, :, 8:], inside[:, :, :-8])
    assert len(np.unique(inside[0])) > 40


@pytest.mark.parametrize("features", ["window", "filters"])
def test_quarter_turns_label_what_the_turned_sample_shows(features):
    """A sample beside itself turned has the same textons both ways up."""
    base = noise(64, 64)
    both = np.concatenate([base, np.rot90(base)], axis=1)
    textons = learn_textons(from_array(both), orientations=4, features=features)
    inside = slice(24, 40)  # where no filter reaches the border between the two
    turned = np.rot90(textons.labels[1][:, :64])[inside, inside]
    upright = textons.labels[0][:, 64:][inside, inside]
    assert (turned == upright).mean() > 0.99


def test_a_flat_sample_has_one_texton_and_a_small_one_few():
    flat = learn_textons(from_array(np.full((20, 20, 3), 90, np.uint8)))
    assert flat.count == 1 and (flat.labels == 0).all() and flat.distance.shape == (1, 1)
    board = (np.indices((40, 40)).sum(0) % 2 * 255).astype(np.uint8)
    assert len(np.unique(learn_textons(from_array(board)).labels[0][8:-8, 8:-8])) == 2
    assert learn_textons(from_array(noise(8, 8)), features="filters").count == 8
    lone = np.zeros((16, 16), bool)
    lone[3, 4] = True
    assert learn_textons(from_array(noise(16, 16), mask=lone)).bucket.tolist() == [3 * 16 + 4]


def test_more_textons_than_texels_are_as_many_as_texels():
    assert learn_textons(from_array(noise(9, 11)), count=5000, orientations=1).count == 99


def test_every_map_has_its_say():
    rows = np.arange(48)[:, None] + np.zeros(48, int)
    grey = to_map(np.full((48, 48, 3), 120, np.uint8), "colour")
    relief = to_map((rows % 12 < 6)[..., None] * np.uint8(255), "data")
    assert learn_textons(Exemplar({"basecolor": grey})).count == 1
    both = learn_textons(Exemplar({"basecolor": grey, "height": relief}))
    assert both.count > 5
    assert (both.labels[0][8:-8, 8:-8] == both.labels[0][8:-8, 8:9]).all()  # rows differ, columns do not


def test_threads_and_seed():
    exemplar = from_array(noise(50, 60))
    found = []
    for threads in (1, 3):
        use(threads=threads)
        found.append(learn_textons(exemplar, orientations=3, seed=4))
    use(threads=2)
    np.testing.assert_array_equal(found[0].labels, found[1].labels)
    np.testing.assert_array_equal(found[0].distance, found[1].distance)
    other = learn_textons(exemplar, orientations=3, seed=5)
    assert (other.labels != found[0].labels).any()


@pytest.mark.parametrize(
    ("words", "message"),
    [
        ({"count": 0}, "0 textons: give 1 or more"),
        ({"width": 8}, "window 8: give an odd number"),
        ({"features": "moments"}, "unknown features 'moments': choose window or filters"),
        ({"orientations": 0}, "0 orientations: give 1 to 64"),
    ],
)
def test_parameters_out_of_range_are_refused(words, message):
    with pytest.raises(ParameterError, match=message):
        learn_textons(from_array(noise(16, 16)), **words)


def test_too_small_a_sample_is_refused():
    with pytest.raises(ExemplarError, match="5x3 texels"):
        learn_textons(from_array(noise(3, 5)))


def test_the_report_may_stop_it():
    def stop(stage: str, done: float) -> None:
        assert 0.0 <= done <= 1.0
        if stage == "orientations":
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        learn_textons(from_array(noise(16, 16)), report=stop)
