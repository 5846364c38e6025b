"""Several samples as one vocabulary, end to end: grown from together, saved, and shown with others in their places."""

import json
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from texloom.cli import main as command
from texloom.cli.reapply import image_domain, reapply, rejoin
from texloom.errors import ParameterError
from texloom.exemplar.colour import decode
from texloom.exemplar.exemplar import from_array
from texloom.exemplar.join import join
from texloom.output.gather import identity_sources
from texloom.output.sources_file import SavedSources, load_sources, save_sources

Captured = pytest.CaptureFixture[str]
SIZES = (40, 48), (56, 44)  # rows, columns


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """Two samples of one kind of noise, blue even in the first and odd in the second; red and green in their places."""
    noise = np.random.default_rng(0)
    for number, size in enumerate(SIZES):
        sample = noise.integers(0, 250, (*size, 3), np.uint8)
        sample[..., 2] = sample[..., 2] // 2 * 2 + number
        Image.fromarray(sample).save(tmp_path / f"sample{number}.png")
        plain = np.zeros((*size, 3), np.uint8)
        plain[..., number] = 255
        Image.fromarray(plain).save(tmp_path / f"plain{number}.png")
    return tmp_path


def runs(*words: object) -> int:
    return command.main([str(word) for word in words])


def grown(folder: Path, *words: object) -> np.ndarray:
    """``out.png`` grown from both samples."""
    samples = folder / "sample0.png", folder / "sample1.png"
    assert runs("image", *samples, "-o", folder / "out.png", "--size", "96x80", *words) == 0
    return np.asarray(Image.open(folder / "out.png"))


@pytest.mark.parametrize("words", [[], ["--preset", "resampling", "--method", "patches"]])
def test_sources_of_several_samples_show_others_in_their_places(folder: Path, words: list[str]) -> None:
    result = grown(folder, "--sources", folder / "s.npz", *words)
    stacks = folder / "plain0.png", folder / "plain1.png"
    assert runs("apply", folder / "s.npz", *stacks, "-o", folder / "plain.png") == 0
    plain = np.asarray(Image.open(folder / "plain.png"))
    light = decode(plain)
    np.testing.assert_allclose(light[..., :2].sum(2), 1.0, atol=0.01)  # the paper's method blends
    assert 0.2 < light[..., 1].mean() < 0.8  # both are there
    if not words:
        np.testing.assert_array_equal(result[..., 2] % 2, light[..., 1])


def test_applied_to_the_samples_themselves_it_is_the_image(folder: Path) -> None:
    result = grown(folder, "--sources", folder / "s.npz")
    assert runs("apply", folder / "s.npz", folder / "sample0.png", folder / "sample1.png", "-o", folder / "b.png") == 0
    again = Image.open(folder / "b.png")
    np.testing.assert_array_equal(np.asarray(again), result)
    assert again.info["sample"] == again.info["applied to"] == "sample0.png, sample1.png"


@pytest.mark.parametrize(
    ("stacks", "given"),
    [
        (["plain0.png"], "the stacks are 48x40"),
        (["plain1.png", "plain0.png"], "the stacks are 44x56, 48x40"),
        (["plain0.png", "plain1.png", "plain1.png"], "the stacks are 48x40, 44x56, 44x56"),
    ],
)
def test_stacks_that_do_not_fit_are_refused_in_one_line(
    folder: Path, stacks: list[str], given: str, capsys: Captured
) -> None:
    grown(folder, "--sources", folder / "s.npz")
    capsys.readouterr()
    assert runs("apply", folder / "s.npz", *(folder / stack for stack in stacks), "-o", folder / "b.png") == 2
    err = capsys.readouterr().err
    assert err.count("\n") == 1 and f"s.npz was made from samples of 48x40, 44x56 texels, but {given}: give one" in err
    assert not (folder / "b.png").exists()


def test_a_lone_sample_takes_one_stack(folder: Path, capsys: Captured) -> None:
    sources = folder / "s.npz"
    assert runs("image", folder / "sample0.png", "-o", folder / "a.png", "--size", 32, "--sources", sources) == 0
    assert runs("apply", sources, folder / "plain0.png", "-o", folder / "b.png") == 0
    assert runs("apply", sources, folder / "plain1.png", "-o", folder / "c.png") == 2
    assert "a sample of 48x40 texels, but the stack is 44x56: resize" in capsys.readouterr().err
    assert runs("apply", sources, folder / "plain0.png", folder / "plain0.png", "-o", folder / "c.png") == 2


def test_a_map_that_only_some_samples_have_is_left_out_and_told(folder: Path, capsys: Captured) -> None:
    for number in range(2):
        stack = folder / f"stack{number}"
        stack.mkdir()
        (folder / f"sample{number}.png").rename(stack / "basecolor.png")
    Image.open(folder / "plain0.png").convert("L").save(folder / "stack0" / "height.png")
    stacks = folder / "stack0", folder / "stack1"
    words = "--size", 32, "--sources", folder / "s.npz", "--json"
    assert runs("image", *stacks, "-o", folder / "out", *words) == 0
    out, err = capsys.readouterr()
    told = json.loads(out)
    assert told["maps"] == ["basecolor"] and told["dropped"] == ["height"]
    assert err == "texloom: left out, since not all samples have it: height\n"
    assert [file.name for file in (folder / "out").iterdir()] == ["basecolor.png"]
    assert runs("apply", folder / "s.npz", *stacks, "-o", folder / "again", "--json") == 0
    assert json.loads(capsys.readouterr().out)["dropped"] == ["height"]


def test_one_mask_is_not_for_several_samples(folder: Path, capsys: Captured) -> None:
    samples = folder / "sample0.png", folder / "sample1.png"
    assert runs("image", *samples, "-o", folder / "out.png", "--mask", folder / "m.png") == 2
    assert "--mask m.png is for one sample, but 2 were given" in capsys.readouterr().err


def test_a_lone_sample_does_not_score_sources_of_several(folder: Path, capsys: Captured) -> None:
    grown(folder, "--sources", folder / "s.npz")
    assert runs("score", folder / "sample0.png", folder / "s.npz") == 2
    assert "was made from samples of 48x40, 44x56" in capsys.readouterr().err


def test_the_places_of_the_samples_are_kept_not_worked_out_again(folder: Path) -> None:
    """A file stays good where a later version would lay the samples out otherwise."""
    samples = [from_array(np.full((*size, 3), 99 * number, np.uint8)) for number, size in enumerate(SIZES)]
    odd = join(samples[::-1])
    saved = SavedSources(identity_sources(*odd.exemplar.shape), image_domain(*odd.exemplar.shape, odd.exemplar))
    saved = load_sources(save_sources(folder / "odd.npz", saved))
    again = rejoin(saved, samples[::-1], "odd.npz")
    assert again.parts == odd.parts
    shown = reapply(saved, again.exemplar, "odd.npz")["basecolor"]
    np.testing.assert_array_equal(shown.image, odd.exemplar.lead.image)
    with pytest.raises(ParameterError, match="in this order"):
        rejoin(saved, samples, "odd.npz")
    with pytest.raises(ParameterError, match="in this order"):
        reapply(saved, join(samples).exemplar, "odd.npz")
