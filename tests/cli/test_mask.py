"""``--mask``: only the white part of the sample is used."""

import json
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from texloom.cli import main as command

Captured = pytest.CaptureFixture[str]


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A sample whose right half is red, and masks."""
    sample = np.random.default_rng(0).integers(0, 200, (32, 64, 3), np.uint8)
    sample[..., 0] = 0
    sample[:, 32:] = (255, 0, 0)
    Image.fromarray(sample).save(tmp_path / "sample.png")
    left = np.zeros((32, 64), np.uint8)
    left[:, :32] = 255
    Image.fromarray(left).save(tmp_path / "left.png")
    Image.fromarray(left[:, :40]).save(tmp_path / "narrow.png")
    Image.fromarray(left * 0).save(tmp_path / "black.png")
    return tmp_path


@pytest.mark.parametrize("words", [[], ["--method", "patches"], ["--preset", "resampling", "--method", "patches"]])
def test_nothing_outside_the_mask_is_shown(folder: Path, words: list[str]) -> None:
    grow = ["image", folder / "sample.png", "-o", folder / "out.png", "--size", 40, "--mask", folder / "left.png"]
    assert command.main([*map(str, grow), *words]) == 0
    assert np.asarray(Image.open(folder / "out.png"))[..., 0].max() == 0


def test_on_a_surface_too(folder: Path, capsys: Captured) -> None:
    (folder / "square.obj").write_text("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n")
    words = ["surface", folder / "square.obj", folder / "sample.png", "-o", folder / "out.glb", "--repeats", 1]
    words += ["--mask", folder / "left.png", "--preview", folder / "p.png", "--json"]
    assert command.main([str(word) for word in words]) == 0
    assert json.loads(capsys.readouterr().out)["maps"] == ["basecolor"]
    picture = np.asarray(Image.open(folder / "p.png")).astype(int)
    assert (picture[..., 0] - picture[..., 1:].max(2)).max() < 40  # no red


@pytest.mark.parametrize(
    ("mask", "message"),
    [
        ("narrow.png", "mask is 40x32"),
        ("black.png", "sample.png: the mask leaves none of 2048 texels"),
        ("missing.png", "missing.png: no such file"),
    ],
)
def test_bad_masks_are_one_line(folder: Path, mask: str, message: str, capsys: Captured) -> None:
    grow = ["image", str(folder / "sample.png"), "-o", str(folder / "out.png"), "--mask", str(folder / mask)]
    assert command.main(grow) == 2
    out, err = capsys.readouterr()
    assert not out and err.count("\n") == 1 and message in err
    assert not (folder / "out.png").exists()
