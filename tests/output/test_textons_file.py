"""Textons kept in a file come back whole with their sample; others are refused by name."""

import json

import numpy as np
import pytest

from texloom.errors import FileError
from texloom.exemplar.exemplar import Exemplar, Map, to_map
from texloom.exemplar.join import join
from texloom.output.textons_file import load_textons, read_entry, save_textons
from texloom.search.textons import Textons, learn_textons

RNG = np.random.default_rng(8)


def stack(rows: int = 20, columns: int = 24) -> Exemplar:
    """Maps of every kind and depth, and a mask."""
    mask = np.ones((rows, columns), bool)
    mask[:5, :7] = False
    return Exemplar(
        {
            "basecolor": to_map(RNG.integers(0, 256, (rows, columns, 3), dtype=np.uint8), "colour"),
            "emissive": to_map(RNG.integers(0, 65536, (rows, columns, 3), dtype=np.uint16), "colour"),
            "normal": to_map(RNG.integers(0, 65536, (rows, columns, 3), dtype=np.uint16), "normal"),
            "roughness": Map(RNG.random((rows, columns, 1), np.float32), "data", 8),  # not what 8 bits can hold
            "height": to_map(RNG.normal(size=(rows, columns, 1)).astype(np.float32), "data"),
        },
        mask,
    )


@pytest.fixture(scope="module")
def learnt() -> Textons:
    return learn_textons(stack(), orientations=3, seed=2)


def rewritten(path, **changed):
    """The same file with arrays or entries of its header changed."""
    arrays = dict(np.load(path))
    header = json.loads(str(arrays["header"]))
    for name, value in changed.items():
        if name in header:
            header[name] = value
        else:
            arrays[name] = value
    with path.open("wb") as file:
        np.savez(file, **(arrays | {"header": np.array(json.dumps(header))}))


def test_write_then_read_is_identity(tmp_path, learnt):
    found = load_textons(save_textons(tmp_path / "a.textons", learnt, made={"sample": "moss"}))
    for name in ("image", "labels", "distance", "bucket", "bucket_start"):
        before, after = getattr(learnt, name), getattr(found, name)
        np.testing.assert_array_equal(after, before)
        assert after.dtype == before.dtype and after.flags.c_contiguous
    assert (found.settings, found.passes, found.kept) == (learnt.settings, learnt.passes, learnt.kept)
    assert list(found.exemplar.maps) == list(learnt.exemplar.maps)
    for name, m in learnt.exemplar.maps.items():
        again = found.exemplar.maps[name]
        assert (again.kind, again.bits) == (m.kind, m.bits)
        np.testing.assert_array_equal(again.image, m.image)
    np.testing.assert_array_equal(found.exemplar.mask, learnt.exemplar.mask)
    again = save_textons(tmp_path / "b.textons", found, made={"sample": "moss"})
    assert again.read_bytes() == (tmp_path / "a.textons").read_bytes()


def test_integers_are_kept_as_integers(tmp_path, learnt):
    with np.load(save_textons(tmp_path / "a.textons", learnt)) as archive:
        kept = {name: archive[f"map.{name}"].dtype for name in learnt.exemplar.maps}
    assert kept == {"basecolor": "u1", "emissive": "u2", "normal": "u2", "roughness": "f4", "height": "f4"}


def test_several_samples_side_by_side_stay_so(tmp_path):
    joined = join([stack(), stack(12, 10)]).exemplar
    found = load_textons(save_textons(tmp_path / "a.textons", learn_textons(joined, orientations=1)))
    assert found.exemplar.parts == joined.parts and len(joined.parts) == 2


def test_the_entry_tells_what_the_file_holds(tmp_path, learnt):
    path = save_textons(tmp_path / "a.textons", learnt, made={"sample": "moss"})
    entry = read_entry(path)
    assert (entry.size, entry.textons, entry.settings) == ((24, 20), learnt.count, learnt.settings)
    assert entry.maps == {"basecolor": 8, "emissive": 16, "normal": 16, "roughness": 8, "height": 32}
    assert entry.masked == pytest.approx(35 / 480) and entry.made == {"sample": "moss"}
    assert entry.bytes == path.stat().st_size


def test_damage_anywhere_is_refused(tmp_path, learnt):
    path = save_textons(tmp_path / "a.textons", learnt)
    whole = path.read_bytes()
    for at in [*RNG.integers(0, len(whole), 60), *range(len(whole) - 700, len(whole))]:  # the archive's directory too
        path.write_bytes(whole[:at] + bytes([whole[at] ^ 0x55]) + whole[at + 1 :])
        try:
            np.testing.assert_array_equal(load_textons(path).labels, learnt.labels)  # what tells nothing may change
        except FileError as error:
            assert "a.textons" in str(error) and "\n" not in str(error)
    for size in (0, 10, len(whole) // 2, len(whole) - 1):
        path.write_bytes(whole[:size])
        with pytest.raises(FileError, match="a.textons is not a file of textons, or is damaged"):
            load_textons(path)


@pytest.mark.parametrize(
    "changed",
    [
        {"labels": np.full((3, 20, 24), 10_000, np.int16)},
        {"labels": np.full((3, 20, 24), -2, np.int16)},
        {"labels": np.zeros((3, 20, 24), np.int16)},  # masked texels too
        {"labels": np.where(stack().usable, 0, -9).astype(np.int16)[None].repeat(3, axis=0)},
        {"labels": np.zeros((2, 20, 24), np.int16)},
        {"distance": np.zeros((2, 3), np.float32)},
        {"map.basecolor": np.zeros((20, 24, 3), np.uint8)},
        {"map.height": np.zeros((4, 24, 1), np.float32)},
        {"mask": np.ones((20, 24), bool)},
        {"settings": {"orientations": 0}},
        {"maps": {}},
        {"fingerprint": "0"},
    ],
    ids=lambda changed: next(iter(changed)),
)
def test_what_does_not_fit_together_is_refused(tmp_path, learnt, changed):
    path = save_textons(tmp_path / "a.textons", learnt)
    rewritten(path, **changed)
    with pytest.raises(FileError, match="a.textons is damaged: learn the textons again"):
        load_textons(path)


def test_others_are_refused_by_name(tmp_path, learnt):
    path = save_textons(tmp_path / "a.textons", learnt)
    rewritten(path, format=99)
    for read in (load_textons, read_entry):
        with pytest.raises(FileError, match="a.textons holds textons of format 99, this texloom reads format 1"):
            read(path)
    np.savez(tmp_path / "b.npz", header=np.array(json.dumps({"kind": "texloom-sources", "format": 1})))
    np.savez(tmp_path / "c.npz", other=1)
    np.save(tmp_path / "d.npy", np.zeros(3))
    for name in ("b.npz", "c.npz", "d.npy"):
        with pytest.raises(FileError, match=f"{name} is not a file of textons"):
            load_textons(tmp_path / name)
    for name in ("missing.textons", "."):
        with pytest.raises(FileError, match="no such file"):
            load_textons(tmp_path / name)


def test_nothing_is_left_behind_where_it_cannot_be_written(tmp_path, learnt):
    with pytest.raises(FileError, match="no folder"):
        save_textons(tmp_path / "no" / "a.textons", learnt)
    assert not list(tmp_path.iterdir())
