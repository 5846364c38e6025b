"""``texloom fill``: holes from masks and from transparency, whole stacks, and what is refused."""

import json
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from tests.synthesis.samples import blobs
from texloom.cli import main as command

Captured = pytest.CaptureFixture[str]


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A picture with masks, a cut-out, and a stack."""
    picture, mask = blobs(48), np.zeros((48, 48), np.uint8)
    mask[14:30, 20:40] = 255
    Image.fromarray(picture).save(tmp_path / "picture.png")
    Image.fromarray(mask).save(tmp_path / "mask.png")
    Image.fromarray(mask * 0).save(tmp_path / "empty.png")
    Image.fromarray(mask * 0 + 255).save(tmp_path / "all.png")
    Image.fromarray(mask[:40]).save(tmp_path / "low.png")
    cut = np.dstack([picture, 255 - mask])
    cut[13, 20:40, 3], cut[12:14, 20:40, :3] = 90, 255  # a soft and tinged rim
    Image.fromarray(cut).save(tmp_path / "cut.png")
    (tmp_path / "stack").mkdir()
    Image.fromarray(picture).save(tmp_path / "stack" / "basecolor.png")
    Image.fromarray(picture[..., 0].astype(np.uint16) * 200).save(tmp_path / "stack" / "height.png")
    normal = np.random.default_rng(1).integers(90, 250, (48, 48, 3), np.uint8)
    Image.fromarray(normal).save(tmp_path / "stack" / "normal.png")
    dark = 255 - mask
    dark[40:, :8] = 0  # not to be imitated, but not to be filled either
    Image.fromarray(dark).save(tmp_path / "stack" / "mask.png")
    return tmp_path


def fill(*words: object) -> int:
    return command.main(["fill", *map(str, words)])


def read(path: Path) -> np.ndarray:
    with Image.open(path) as image:
        return np.asarray(image)


def test_the_hole_is_filled_and_the_rest_stays(folder: Path, capsys: Captured) -> None:
    files = ["--sources", folder / "s.npz", "--report", folder / "r.html"]
    assert fill(folder / "picture.png", "--mask", folder / "mask.png", "-o", folder / "out.png", *files, "--json") == 0
    told = json.loads(capsys.readouterr().out)
    assert told["filled"] == 16 * 20 and told["size"] == [48, 48] and 0.5 < told["border"] < 2
    out, hole = read(folder / "out.png"), read(folder / "mask.png") > 0
    np.testing.assert_array_equal(out[~hole], blobs(48)[~hole])
    known = {tuple(texel) for texel in blobs(48)[~hole]}
    assert all(tuple(texel) in known for texel in out[hole])
    assert (folder / "r.html").stat().st_size > 1000

    assert command.main(["apply", *map(str, [folder / "s.npz", folder / "picture.png", "-o", folder / "a.png"])]) == 0
    np.testing.assert_array_equal(read(folder / "a.png"), out)


def test_what_is_transparent_is_filled_with_its_rim_and_the_result_is_opaque(folder: Path) -> None:
    assert fill(folder / "cut.png", "-o", folder / "out.png") == 0
    out, picture = read(folder / "out.png"), blobs(48)
    assert out.shape == (48, 48, 3) and (out[12:31, 19:41] != 255).any(2).all()
    np.testing.assert_array_equal(out[:, :18], picture[:, :18])


def test_a_stack_is_filled_alike_and_keeps_every_bit(folder: Path) -> None:
    words = [folder / "stack", "--mask", folder / "mask.png", "-o", folder / "out", "--method", "patches", "--tileable"]
    assert fill(*words) == 0
    hole = read(folder / "mask.png") > 0
    for name in ("basecolor", "height", "normal"):
        now, was = read(folder / "out" / f"{name}.png"), read(folder / "stack" / f"{name}.png")
        assert now.dtype == was.dtype
        np.testing.assert_array_equal(now[~hole], was[~hole])
    colour, height = read(folder / "out" / "basecolor.png"), read(folder / "out" / "height.png")
    np.testing.assert_array_equal(height, colour[..., 0].astype(height.dtype) * 200)


def test_without_a_mask_a_stack_is_filled_where_its_own_is_dark(folder: Path, capsys: Captured) -> None:
    assert fill(folder / "stack", "-o", folder / "out", "--json") == 0
    assert json.loads(capsys.readouterr().out)["filled"] == 16 * 20 + 8 * 8


def test_an_empty_mask_gives_the_picture(folder: Path, capsys: Captured) -> None:
    assert fill(folder / "picture.png", "--mask", folder / "empty.png", "-o", folder / "out.png", "--json") == 0
    told = json.loads(capsys.readouterr().out)
    assert told["filled"] == 0 and told["border"] is None and told["stopped"] == "nothing to fill"
    np.testing.assert_array_equal(read(folder / "out.png"), blobs(48))


def test_everything_from_a_sample(folder: Path) -> None:
    words = [folder / "cut.png", "--mask", folder / "all.png", "--sample", folder / "picture.png"]
    assert fill(*words, "-o", folder / "out") == 0
    known = {tuple(texel) for texel in blobs(48).reshape(-1, 3)}
    assert all(tuple(texel) in known for texel in read(folder / "out" / "basecolor.png").reshape(-1, 3))


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["picture.png"], "no transparent part: give --mask"),
        (["picture.png", "--mask", "low.png"], "48x40 texels, but the picture is 48x48"),
        (["picture.png", "--mask", "all.png"], "give a sample"),
        (["picture.png", "--mask", "missing.png"], "missing.png: no such file"),
        (["stack", "--mask", "mask.png", "--sample", "picture.png"], "one file, but there are 3 maps"),
        (["picture.png", "--mask", "mask.png", "--method", "magic"], "unknown method 'magic'"),
    ],
)
def test_what_cannot_be_done_is_one_line(folder: Path, words: list[str], message: str, capsys: Captured) -> None:
    given = [word if word.startswith("--") or word == "magic" else folder / word for word in words]
    assert fill(*given, "-o", folder / "out.png") == 2
    out, err = capsys.readouterr()
    assert not out and err.count("\n") == 1 and message in err
    assert not (folder / "out.png").exists()
