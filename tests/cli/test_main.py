"""How the command behaves, whatever the command: help, errors in one line, exit status, speed of starting."""

import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from texloom.cli import main as command
from texloom.errors import MeshError

Captured = pytest.CaptureFixture[str]


@pytest.fixture
def sample(tmp_path: Path) -> Path:
    path = tmp_path / "sample.png"
    Image.fromarray((np.indices((24, 32)).sum(0)[..., None] * [4, 3, 2]).astype(np.uint8)).save(path)
    return path


def fails_in_one_line(arguments: list[object], capsys: Captured) -> str:
    assert command.main([str(word) for word in arguments]) == 2
    out, err = capsys.readouterr()
    assert out == ""
    assert err.startswith("texloom: ") and err.count("\n") == 1
    return err


def test_help_lists_the_commands(capsys: Captured) -> None:
    assert command.main([]) == 0
    out = capsys.readouterr().out
    for name in ("image", "surface", "apply", "textons", "inspect", "score", "demo"):
        assert f"  {name} " in out


@pytest.mark.parametrize("name", ["image", "surface", "apply", "textons", "inspect", "score", "demo"])
def test_every_command_explains_itself(name: str, capsys: Captured) -> None:
    assert command.main([name, "--help"]) == 0
    assert "Usage: texloom " + name in capsys.readouterr().out


def test_version(capsys: Captured) -> None:
    assert command.main(["--version"]) == 0
    assert capsys.readouterr().out.startswith("texloom ")


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["imagine"], "imagine"),
        (["image"], "SAMPLE"),
        (["image", "{sample}"], "--output"),
        (["image", "{sample}", "-o", "out.png", "--seed", "seven"], "--seed"),
        (["image", "{sample}", "-o", "out.png", "--threads", "0"], "--threads"),
        (["image", "{sample}", "-o", "out.png", "--size", "0x4"], "--size 0x4: sides go from 1 to 32768 texels"),
        (["image", "{sample}", "-o", "out.png", "--size", "large"], "give for example 512 or 640x480"),
        (["image", "{sample}", "-o", "out.png", "--method", "weave"], "'weave': choose optimize, patches"),
        (
            ["image", "{sample}", "-o", "out.png", "--search", "x"],
            "pca, pca-tree, pca-clusters or clusters",
        ),
        (
            ["image", "{sample}", "-o", "out.png", "--passes", "3"],
            "--passes 3 is not for optimize: add --method refine",
        ),
        (
            ["image", "{sample}", "-o", "out.png", "--method", "refine", "--order", "spiral"],
            "unknown order 'spiral'",
        ),
        (["image", "{sample}", "-o", "out.png", "--method", "refine", "--window", "1"], "window 1 is too small"),
        (["image", "{sample}", "-o", "out.png", "--preset", "x"], "unknown preset 'x': choose resampling"),
        (["image", "{sample}", "-o", "out.png", "--search", "pca"], "add --preset resampling"),
        (["image", "{sample}", "{sample}", "-o", "out.png", "--mask", "m.png"], "--mask m.png is for one sample"),
        (["image", "{sample}", "-o", "nowhere/out.png"], "there is no folder nowhere"),
        (["score", "bunny.glb", "{sample}"], "bunny.glb is a mesh: the first file is the sample"),
        (["score", "{sample}", "bunny.stl"], "bunny.stl is a mesh without a direction field"),
        (["image", "{sample}", "-o", "out.png", "--report", "r.pdf"], "a report is a page, name it .html"),
        (["image", "{sample}", "-o", "out.png", "--report", "nowhere/r.html"], "there is no folder nowhere"),
        (["inspect", "nothing.png"], "nothing.png: no such file"),
        (["apply", "nothing.npz", "{sample}", "-o", "out.png"], "nothing.npz"),
    ],
)
def test_bad_input_is_one_line(arguments: list[str], message: str, sample: Path, capsys: Captured) -> None:
    assert message in fails_in_one_line([word.format(sample=sample) for word in arguments], capsys)


def test_an_error_of_many_lines_is_said_in_one(sample: Path, capsys: Captured, monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(*_: object, **__: object) -> None:
        raise MeshError("first\n   second")

    monkeypatch.setattr("texloom.io.stack.read_exemplar", refuse)
    assert fails_in_one_line(["inspect", sample], capsys) == "texloom: first second\n"


def test_an_interrupt_says_that_nothing_was_written(
    sample: Path, capsys: Captured, monkeypatch: pytest.MonkeyPatch
) -> None:
    def interrupt(*_: object, **__: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr("texloom.io.stack.read_exemplar", interrupt)
    assert command.main(["inspect", str(sample)]) == 130
    assert capsys.readouterr().err == "texloom: interrupted, nothing written\n"


def test_inspect_an_image(sample: Path, capsys: Captured) -> None:
    assert command.main(["inspect", str(sample), "--json"]) == 0
    facts = json.loads(capsys.readouterr().out)
    assert facts["size"] == [32, 24]
    assert facts["maps"]["basecolor"]["bits"] == 8
    assert facts["files"] == []
    assert command.main(["inspect", str(sample)]) == 0
    assert "32×24" in capsys.readouterr().out


def test_a_sample_scores_perfectly_against_itself(sample: Path, capsys: Captured) -> None:
    assert command.main(["score", str(sample), str(sample), "--json"]) == 0
    scores = json.loads(capsys.readouterr().out)["scores"]["basecolor"]
    assert scores["swd"] == scores["coherence"] == scores["completeness"] == 0
    assert command.main(["score", str(sample), str(sample)]) == 0
    header, row = capsys.readouterr().out.splitlines()
    assert header.split() == ["map", "swd", "coherence", "completeness", "copy", "seam"]
    assert row.split()[:2] == ["basecolor", "0.000"]


def test_refine_patches_makes_images_without_a_field(sample: Path, tmp_path: Path, capsys: Captured) -> None:
    out = tmp_path / "out.png"
    words = ["image", sample, "-o", out, "--size", "40x30", "--method", "refine-patches"]
    assert command.main([*map(str, words), "--tileable", "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["patches"] > 1 and Image.open(out).size == (40, 30)
    out.unlink()
    assert "use optimize there" in fails_in_one_line([*words, "--field", "ring"], capsys) and not out.exists()


def test_parsing_imports_nothing_heavy() -> None:
    """What a command line costs before its work begins."""
    program = (
        "import sys; from texloom.cli.main import main; main(['image', '--help']); "
        "print([name for name in ('numpy', 'warp', 'scipy', 'PIL', 'rich') if name in sys.modules])"
    )
    run = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    assert run.stdout.splitlines()[-1] == "[]"


def test_an_image_waits_for_nothing_that_it_does_not_need(sample: Path, tmp_path: Path) -> None:
    heavy = ("rich", "trimesh", "igl", "potpourri3d", "xatlas", "tifffile", "scipy.sparse", "scipy.ndimage", "pydoc")
    program = (
        "import sys; from texloom.cli.main import main; "
        f"status = main(['image', {str(sample)!r}, '-o', {str(tmp_path / 'out.png')!r}, '--size', '16']); "
        f"print(status, [name for name in {heavy} if name in sys.modules])"
    )
    run = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    assert run.stdout.splitlines()[-1] == "0 []"


def test_an_image_grows_and_its_sources_apply_again(tmp_path: Path, capsys: Captured) -> None:
    from texloom.demo import write_sample

    write_sample(tmp_path / "weave", "weave", size=48)
    grow = ["image", tmp_path / "weave", "-o", tmp_path / "grown", "--size", "64x40", "--sources", tmp_path / "s.npz"]
    assert command.main([*map(str, grow), "--json", "--seed", "3"]) == 0
    facts = json.loads(capsys.readouterr().out)
    assert facts["size"] == [64, 40] and facts["seed"] == 3 and len(facts["files"]) == 7
    assert Image.open(tmp_path / "grown" / "basecolor.png").size == (64, 40)

    again = ["apply", tmp_path / "s.npz", tmp_path / "weave", "-o", tmp_path / "again"]
    assert command.main([str(word) for word in again]) == 0
    for name in ("basecolor", "normal", "height"):
        first, second = (np.asarray(Image.open(tmp_path / f / f"{name}.png")) for f in ("grown", "again"))
        np.testing.assert_array_equal(first, second)


def test_a_stack_does_not_fit_into_one_file(tmp_path: Path, capsys: Captured) -> None:
    from texloom.demo import write_sample

    write_sample(tmp_path / "weave", "weave", size=48)
    message = fails_in_one_line(["image", tmp_path / "weave", "-o", tmp_path / "out.png"], capsys)
    assert "out.png is one file, but there are 6 maps" in message
    assert not (tmp_path / "out.png").exists()


def test_sources_are_for_samples_of_one_size(sample: Path, tmp_path: Path, capsys: Captured) -> None:
    from texloom.demo import write_sample

    arguments = ["image", sample, "-o", tmp_path / "a.png", "--size", "16", "--sources", tmp_path / "s.npz"]
    assert command.main([str(word) for word in arguments]) == 0
    capsys.readouterr()
    write_sample(tmp_path / "weave", "weave", size=48)
    message = fails_in_one_line(["apply", tmp_path / "s.npz", tmp_path / "weave", "-o", tmp_path / "b"], capsys)
    assert "made from a sample of 32x24 texels, but the stack is 48x48" in message
