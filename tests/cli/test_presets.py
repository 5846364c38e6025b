"""``--preset``: a paper's own way of doing each task, and one line where it has none."""

import json
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from tests.synthesis.samples import blobs
from texloom.cli import main as command
from texloom.cli.methods import wish
from texloom.cli.options import PRESET_METHODS, PRESETS, SURFACE_METHODS, SURFACE_PRESETS
from texloom.demo.polygonise import polygonise
from texloom.demo.shapes import ball
from texloom.demo.write import write_obj
from texloom.domain.grid import Grid
from texloom.errors import ParameterError
from texloom.exemplar.exemplar import from_array
from texloom.synthesis.optimize import Optimize
from texloom.synthesis.refine import Refine
from texloom.synthesis.refine_patches import RefinePatches
from texloom.synthesis.sweep import Sweep
from texloom.systems import refine, sweep

Captured = pytest.CaptureFixture[str]


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Two samples, a hole, a map and a ball."""
    folder = tmp_path_factory.mktemp("presets")
    hole = np.zeros((48, 48), np.uint8)
    hole[8:16, 2:14] = 255
    Image.fromarray(hole).save(folder / "hole.png")
    column = np.arange(44)[None].repeat(32, 0)[..., None]
    Image.fromarray(np.where(column < 22, (255, 0, 0), (0, 0, 255)).astype(np.uint8)).save(folder / "map.png")
    for number in (0, 1):
        Image.fromarray(blobs(48, seed=number)).save(folder / f"{number}.png")
    faces = polygonise(ball((0, 0, 0), 1.0), low=np.full(3, -1.3), high=np.full(3, 1.3), step=0.5)
    write_obj(folder / "ball.obj", faces)
    return folder


def run(folder: Path, words: str) -> int:
    """The words, with % for the folder."""
    return command.main([word.replace("%", str(folder)) for word in words.split()])


def test_every_preset_has_methods_and_is_known_by_name() -> None:
    """Textons are wired apart: their method chooses faces, not sites."""
    assert (*PRESET_METHODS, "texton") == SURFACE_PRESETS and set(PRESETS) < set(PRESET_METHODS)
    assert [*(name for names in PRESET_METHODS.values() for name in names), "texton"] == list(SURFACE_METHODS)


def test_sweep_is_for_surfaces_and_takes_its_own_parameters() -> None:
    ours = wish("sweep", "tree", None, surface=True, levels=2, window=5, start=None)
    assert ours.build() == Sweep(search="tree", levels=2, window=5)
    assert wish(None, None, "sweep", surface=True, shape="causal").build() == sweep.sweeps(shape="causal")
    with pytest.raises(ParameterError, match="unknown method 'sweep'"):
        wish("sweep", None, None)
    with pytest.raises(ParameterError, match="--levels 2 is not for optimize: add --method sweep"):
        wish(None, None, None, surface=True, levels=2)
    with pytest.raises(ParameterError, match="unknown search 'pca': choose coherence or tree"):
        wish("sweep", "pca", None, surface=True)
    with pytest.raises(ParameterError, match="cannot continue one"):
        ours.grower("fuse")


def test_refine_is_the_papers_for_each_task() -> None:
    wanted = wish(None, None, "refine", passes=None)
    assert wanted.method == "refine" and wanted.build() == refine.refinement()
    assert wanted.grower("fill") == Refine(order="scan-line", passes=4, threshold=0)
    assert wanted.grower("fuse") == refine.refinement(passes=1)
    assert wanted.belt_method() is refine.belt_refinement and wish(None, None, None).belt_method() is None
    placed = wish("refine-patches", None, "refine").build()
    assert isinstance(placed, RefinePatches) and placed.fill == refine.refinement(passes=4)
    set_by_hand = wish(None, None, "refine", passes=2, window=9).build()
    assert set_by_hand == Refine(order="scan-line", passes=2, window=9)


def test_ours_continue_a_canvas_and_whole_textures_do_not() -> None:
    assert isinstance(wish(None, None, None).grower("fill"), Optimize)
    assert wish("refine", None, None).grower("fuse") == Refine()
    with pytest.raises(ParameterError, match="cannot continue one: choose --preset refine"):
        wish(None, None, "resampling").grower("fill")


def test_image_fill_and_fuse_do_what_the_paper_does(folder: Path, capsys: Captured) -> None:
    """The commands' sources are those of the system's own functions."""
    samples = [from_array(blobs(48, seed=number)) for number in (0, 1)]
    hole = np.asarray(Image.open(folder / "hole.png")) > 0
    labels = (np.arange(44) >= 22).astype(np.int32)[None].repeat(32, 0).ravel()
    ours = refine.fusion(samples, labels, Grid(32, 44), seed=3).result
    filled = refine.filling(samples[0], hole, seed=3).result
    for words, result in (
        ("fill %/0.png --mask %/hole.png", filled),
        ("fuse %/map.png %/0.png %/1.png --palette red,blue", ours),
    ):
        both = f"{words} --preset refine --seed 3 -o %/out.png --sources %/out.npz --json"
        assert run(folder, both) == 0
        facts = json.loads(capsys.readouterr().out)
        assert (facts["method"], facts["preset"]) == ("refine", "refine")
        assert len(facts["energy"]) == (4 if words.startswith("fill") else 1)
        np.testing.assert_array_equal(np.load(folder / "out.npz")["position"], result.sources.position)
    assert run(folder, "image %/0.png --size 24 --preset refine --passes 2 -o %/out.png --json") == 0
    assert json.loads(capsys.readouterr().out)["method"] == "refine"
    assert "scan-line" in str(Image.open(folder / "out.png").info)


@pytest.mark.parametrize(
    ("words", "said"),
    [
        ("image %/0.png --preset refine --search pca", "--search pca is for --preset resampling, refine has its own"),
        (
            "image %/0.png --preset refine --analysis %/a.npz",
            "--analysis a.npz is for --preset resampling, refine keeps",
        ),
        ("image %/0.png --preset refine --method optimize", "refine has no optimize: choose refine or refine-patches"),
        ("image %/0.png --preset refine --field ring --size 20", "scan-line order needs an image without a field"),
        ("fill %/0.png --mask %/hole.png --preset resampling", "cannot continue one"),
        ("fuse %/map.png %/0.png %/1.png --preset resampling", "cannot continue one"),
        ("fuse %/map.png %/0.png %/1.png --preset refine --belts cut", "--preset refine says how belts are filled"),
        ("surface %/ball.obj %/0.png --preset refine", "a mesh has none of: give --method refine"),
        ("surface %/ball.obj %/0.png %/1.png --fuse vertex --preset refine", "a mesh has none of"),
    ],
)
def test_what_a_preset_does_not_have_is_said_in_one_line(folder: Path, words: str, said: str, capsys: Captured) -> None:
    output = folder / ("bad.glb" if words.startswith("surface") else "bad.png")
    assert run(folder, f"{words} -o {output}") == 2
    error = capsys.readouterr().err.strip()
    assert said in error and "\n" not in error and len(error) < 200
    assert not output.exists()
