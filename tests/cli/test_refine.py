"""``--method refine`` where it is offered."""

import json
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from tests.meshes import sphere
from tests.synthesis.samples import blobs
from texloom.cli import main as command

Captured = pytest.CaptureFixture[str]


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    for seed, name in enumerate("ab"):
        Image.fromarray(blobs(40, seed=seed)).save(tmp_path / f"{name}.png")
    hole = np.zeros((40, 40), np.uint8)
    hole[14:26, 10:24] = 255
    Image.fromarray(hole).save(tmp_path / "hole.png")
    Image.fromarray(np.repeat(hole[..., None] // 255 * [200, 30, 30], 1, 2).astype(np.uint8)).save(tmp_path / "map.png")
    ball = sphere(1)
    lines = [f"v {x} {y} {z}" for x, y, z in ball.vertices] + [f"f {a} {b} {c}" for a, b, c in ball.faces + 1]
    (tmp_path / "ball.obj").write_text("\n".join(lines))
    return tmp_path


def run(words: list[object], capsys: Captured) -> dict:
    assert command.main([str(word) for word in [*words, "--method", "refine", "--json"]]) == 0
    return json.loads(capsys.readouterr().out)


@pytest.mark.parametrize("order", ["parallel", "scan-line"])
def test_an_image_tells_the_curves_of_its_passes(order: str, folder: Path, capsys: Captured) -> None:
    words = ["image", folder / "a.png", "-o", folder / "out.png", "--size", "30x24"]
    facts = run([*words, "--order", order, "--window", 9, "--passes", 3], capsys)
    assert facts["method"] == "refine" and set(facts["curves"]) == {"MSE", "changed pixels", "difference"}
    passes = len(facts["curves"]["MSE"])
    assert 1 <= passes <= 3 and len(facts["energy"]) == passes + (order == "scan-line")
    with Image.open(folder / "out.png") as image:
        assert image.size == (30, 24)
        assert f"order='{order}'" in image.info["method"]


def test_holes_regions_and_meshes_are_refined_too(folder: Path, capsys: Captured) -> None:
    run(["fill", folder / "a.png", "--mask", folder / "hole.png", "-o", folder / "filled.png"], capsys)
    run(["fuse", folder / "map.png", folder / "a.png", folder / "b.png", "-o", folder / "fused.png"], capsys)
    run(["surface", folder / "ball.obj", folder / "a.png", "-o", folder / "ball.glb"], capsys)


def test_a_field_needs_the_parallel_order(folder: Path, capsys: Captured) -> None:
    words = [
        "image",
        folder / "a.png",
        "-o",
        folder / "out.png",
        "--size",
        "24",
        "--field",
        "radial",
        "--method",
        "refine",
    ]
    assert command.main([str(word) for word in [*words, "--order", "scan-line"]]) == 2
    assert "use the parallel order" in capsys.readouterr().err
    assert not (folder / "out.png").exists()


def test_the_papers_method_can_search_in_a_tree(folder: Path, capsys: Captured) -> None:
    words = ["image", folder / "a.png", "-o", folder / "out.png", "--size", "32", "--method", "patches", "--json"]
    assert command.main([str(word) for word in [*words, "--preset", "resampling", "--search", "pca-tree"]]) == 0


def test_both_stopping_rules(folder: Path, capsys: Captured) -> None:
    """Never settled, it makes all its passes; with a threshold above any change, one; a sum exceeds the mean."""
    words = ["image", folder / "a.png", "-o", folder / "out.png", "--size", 32, "--passes", 4]
    mean = run([*words, "--threshold", 0], capsys)
    assert mean["stopped"] == "passes" and len(mean["curves"]["MSE"]) == 4
    assert run([*words, "--threshold", 10], capsys)["stopped"] == "settled"
    total = run([*words, "--threshold", 0, "--difference", "sum"], capsys)
    assert total["curves"]["difference"][0] > 10 * mean["curves"]["difference"][0] > 0
