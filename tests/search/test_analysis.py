"""An analysis is saved whole, taken up again as it was, and refused for other pixels."""

import json

import numpy as np
import pytest

from texloom.errors import ExemplarError, FileError
from texloom.exemplar.exemplar import from_array
from texloom.exemplar.patches import even_samples
from texloom.search import SEARCHES, PcaNearest
from texloom.search.analysis import analyse, load_analysis

RNG = np.random.default_rng(9)


@pytest.fixture
def exemplar():
    mask = np.ones((40, 36), bool)
    mask[:4, :6] = False
    return from_array(RNG.integers(0, 256, (40, 36, 3), dtype=np.uint8), mask=mask)


@pytest.mark.parametrize("search", SEARCHES.values(), ids=SEARCHES)
def test_saved_and_loaded_it_finds_the_same(tmp_path, exemplar, search, monkeypatch):
    analysis = analyse(exemplar, levels=2)
    samples = even_samples(8, 4)
    patches, index = analysis.index(search, 1, 8, samples)
    asked = patches.vectors[::3] + np.float32(0.01)
    analysis.save(tmp_path / "a.npz")
    monkeypatch.setattr(type(search), "prepare", None)  # learning again would fail
    again = load_analysis(tmp_path / "a.npz", exemplar)
    patches_again, index_again = again.index(search, 1, 8, samples)
    np.testing.assert_array_equal(patches_again.vectors, patches.vectors)
    np.testing.assert_array_equal(index_again.nearest(asked).index, index.nearest(asked).index)
    assert [level.usable is None for level in again.levels] == [False, False]


def test_an_index_is_prepared_once_a_request(exemplar):
    analysis = analyse(exemplar)
    samples = even_samples(8, 4)
    first = analysis.index(PcaNearest(), 0, 8, samples)
    assert analysis.index(PcaNearest(), 0, 8, samples) is first
    assert analysis.index(PcaNearest(dimensions=7), 0, 8, samples) is not first
    assert analysis.index(PcaNearest(), 0, 9, samples) is not first
    assert analysis.index(PcaNearest(), 0, 8, even_samples(8, 3)) is not first


def test_other_pixels_are_refused(tmp_path, exemplar):
    analyse(exemplar).save(tmp_path / "a.npz")
    changed = exemplar.lead.image.copy()
    changed[20, 20, 1] = np.nextafter(changed[20, 20, 1], 2)
    with pytest.raises(ExemplarError, match="a.npz is the analysis of other pixels"):
        load_analysis(tmp_path / "a.npz", from_array(changed, mask=exemplar.mask))
    with pytest.raises(ExemplarError, match="other pixels"):
        load_analysis(tmp_path / "a.npz", from_array(exemplar.lead.image))


def test_other_versions_and_other_files_are_refused(tmp_path, exemplar):
    header = {"texloom_analysis": 999, "fingerprint": "", "requests": []}
    np.savez(tmp_path / "a.npz", header=np.array(json.dumps(header)))
    with pytest.raises(FileError, match="version 999"):
        load_analysis(tmp_path / "a.npz", exemplar)
    (tmp_path / "b.npz").write_bytes(b"nothing")
    np.savez(tmp_path / "c.npz", values=np.zeros(3))
    for name in ("b.npz", "c.npz", "missing.npz"):
        with pytest.raises(FileError, match=f"{name} is not a saved analysis"):
            load_analysis(tmp_path / name, exemplar)


def test_nothing_is_left_behind_where_it_cannot_be_written(tmp_path, exemplar):
    with pytest.raises(FileError, match="cannot be written"):
        analyse(exemplar).save(tmp_path / "no" / "a.npz")
    analyse(exemplar).save(tmp_path / "a.npz")
    assert [file.name for file in tmp_path.iterdir()] == ["a.npz"]
