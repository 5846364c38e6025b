"""``texloom sketch``, and ``texloom surface --sketch``."""

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image
from scipy.spatial import KDTree

from tests.data import DATA, needs_data
from texloom.cli import main as command
from texloom.demo.polygonise import polygonise
from texloom.demo.shapes import ball
from texloom.demo.write import write_obj
from texloom.metrics.seam import seam_ratio
from texloom.output.sketch_svg import write_sketch_svg
from texloom.output.sources_file import load_sources
from texloom.sketch.mesh.shown import shown_curves
from texloom.sketch.mesh.texture_mesh import TextureMesh
from texloom.sketch.random import random_cells
from texloom.sketch.reading.read import read_sketch

Captured = pytest.CaptureFixture[str]
SQUARE, SIDE = 12, 72
RED, BLUE = (220, 60, 50), (40, 70, 210)


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Red and blue squares between dark lines with their height and cells, other sketches, and a small ball."""
    folder = tmp_path_factory.mktemp("sketch")
    square = np.arange(SIDE) // SQUARE
    odd = ((square[:, None] + square) % 2).astype(bool)
    kinds = np.where(odd[..., None], RED, BLUE).astype(np.uint8)
    line = np.arange(SIDE) % SQUARE % (SQUARE - 1) == 0
    line = line[:, None] | line
    noise = np.random.default_rng(1).integers(-20, 20, (SIDE, SIDE, 1))
    (folder / "squares").mkdir()
    colours = np.where(line[..., None], 15, kinds + noise).clip(0, 255).astype(np.uint8)
    Image.fromarray(colours).save(folder / "squares" / "basecolor.png")
    Image.fromarray(np.where(line, 30, 200).astype(np.uint8)).save(folder / "squares" / "height.png")
    Image.fromarray(colours).save(folder / "squares.png")
    Image.fromarray(255 - colours).save(folder / "negative.png")
    Image.fromarray(kinds).save(folder / "kinds.png")
    Image.fromarray(np.where(np.arange(SIDE) < 5 * SQUARE, 255, 0).astype(np.uint8)[None].repeat(SIDE, 0)).save(
        folder / "mask.png"
    )
    halves = np.where(np.arange(40)[None, :, None] < 20, RED, BLUE).astype(np.uint8)
    Image.fromarray(np.repeat(halves, 30, axis=0)).save(folder / "halves.png")

    place = np.arange(0, SIDE + 1, SQUARE) - 0.5
    ends = [[(p, place[0]), (p, place[-1])] for p in place] + [[(place[0], p), (place[-1], p)] for p in place]
    tail, head = np.array(ends).transpose(1, 0, 2)
    grid = np.stack([tail, (2 * tail + head) / 3, (tail + 2 * head) / 3, head], axis=1)
    write_sketch_svg(folder / "grid.svg", (SIDE, SIDE), grid)
    cells = random_cells((120.0, 120.0), cell=20.0, seed=3)
    write_sketch_svg(folder / "cells.svg", (120, 120), shown_curves(cells))
    rings = "".join(f'<circle cx="{x}" cy="{y}" r="30"/>' for x in range(20, 200, 35) for y in range(20, 200, 35))
    page = '<svg xmlns="http://www.w3.org/2000/svg" width="200" height="200" fill="none" stroke="black">{}</svg>'
    (folder / "rings.svg").write_text(page.format(rings))
    (folder / "beside.svg").write_text(page.format('<path d="M-500 -500H-300V-300H-500Z M-400 -500V-300"/>'))
    Image.fromarray(np.where(np.indices((SIDE, SIDE)).sum(axis=0) % 4, 255, 0).astype(np.uint8)).save(
        folder / "comb.png"
    )
    (folder / "empty.svg").write_text(page.format(""))
    faces = polygonise(ball((0, 0, 0), 1.0), low=np.full(3, -1.3), high=np.full(3, 1.3), step=0.3)
    write_obj(folder / "ball.obj", faces)
    return folder


def run(folder: Path, *words: str) -> int:
    """The command, with names in the folder in braces."""
    return command.main([word.replace("{", f"{folder}/").replace("}", "") for word in words])


def facts(capsys: Captured) -> dict[str, Any]:
    return json.loads(capsys.readouterr().out)


def pixels(path: Path) -> np.ndarray:
    return np.asarray(Image.open(path), np.float32)


def test_a_texture_and_all_that_is_told(folder: Path, capsys: Captured) -> None:
    words = ["--size", "90x70", "--json", "--sources", "{a.npz}", "--report", "{a.html}", "--threads", "2"]
    cells = ["--sample-sketch", "{grid.svg}"]
    assert run(folder, "sketch", "{cells.svg}", "{squares.png}", "-o", "{a.png}", *cells, *words) == 0
    told = facts(capsys)
    assert told["size"] == [90, 70] and Image.open(folder / "a.png").size == (90, 70)
    assert told["scale"] == pytest.approx(SQUARE / 20, rel=0.03) and told["mirrored"] is False
    assert 90 * 70 / SQUARE**2 < told["cells"] < 2 * 90 * 70 / SQUARE**2 and told["kinds"] == []  # some cut off
    assert told["radius"] == pytest.approx(SQUARE / 4, rel=0.03)
    assert {"read", "cells", "mesh", "maps", "start", "pixels", "write", "report"} < set(told["seconds"])
    assert Image.open(folder / "a.png").info["sketch"] == "cells.svg"
    assert "Lines between cells" in (folder / "a.html").read_text()
    assert run(folder, "apply", "{a.npz}", "{squares.png}", "-o", "{again.png}") == 0
    np.testing.assert_array_equal(pixels(folder / "a.png"), pixels(folder / "again.png"))


def test_a_stack_tiles_in_every_map(folder: Path, capsys: Captured) -> None:
    words = ["-o", "{stack}", "--size", "80x64", "--tileable", "--sample-sketch", "{grid.svg}", "--json"]
    assert run(folder, "sketch", "random", "{squares}", *words) == 0
    assert facts(capsys)["maps"] == ["basecolor", "height"]
    for name in ("basecolor", "height"):
        values = pixels(folder / "stack" / f"{name}.png")
        values = values.reshape(*values.shape[:2], -1)
        assert values.shape[:2] == (64, 80) and seam_ratio(values) <= 1
        assert seam_ratio(values[:-5, :-7]) > 1  # cut elsewhere, it does not


def test_options_change_what_comes(folder: Path, capsys: Captured) -> None:
    shown = {}
    ways = {
        "ours": [],
        "scale": ["--inside", "scale"],
        "preset": ["--preset", "sketch"],
        "seed": ["--seed", "1"],
        "regular": ["--radius", "0"],
        "large": ["--scale", "1"],
        "masked": ["--mask", "{mask.png}", "--sources", "{masked.npz}"],
    }
    for name, words in ways.items():
        assert run(folder, "sketch", "{cells.svg}", "{squares.png}", "-o", "{o.png}", "--size", "48", *words) == 0
        shown[name] = pixels(folder / "o.png")
    assert run(folder, "sketch", "{cells.svg}", "{squares.png}", "-o", "{o.png}", "--size", "48") == 0
    np.testing.assert_array_equal(shown["ours"], pixels(folder / "o.png"))
    names = [*ways]
    assert all((shown[a] != shown[b]).any() for n, a in enumerate(names) for b in names[:n])
    assert load_sources(folder / "masked.npz").sources.position[..., 1].max() < 5 * SQUARE + 2


def test_kinds_go_where_the_pattern_says(folder: Path, capsys: Captured) -> None:
    words = ["--sample-sketch", "{grid.svg}", "--kinds", "{kinds.png}", "--pattern", "{halves.png}", "--json"]
    assert run(folder, "sketch", "{cells.svg}", "{squares.png}", "-o", "{k.png}", "--size", "96", *words) == 0
    told = facts(capsys)["kinds"]
    assert sorted(kind["colour"] for kind in told) == ["#2846d2", "#dc3c32"]
    assert all(0.35 < kind["share"] < 0.65 for kind in told)
    left, right = pixels(folder / "k.png")[:, :36], pixels(folder / "k.png")[:, -36:]
    assert left[..., 0].mean() > 2 * left[..., 2].mean() and right[..., 2].mean() > 2 * right[..., 0].mean()


def test_of_several_samples_the_pattern_says_which(folder: Path, capsys: Captured) -> None:
    palette = np.array([(0, 0, 0), (255, 0, 0)], np.uint8)
    Image.fromarray(palette[np.arange(20)[:, None] // 10].repeat(20, 1)).save(folder / "above.png")
    samples = ["{squares.png}", "{negative.png}", "--sample-sketch", "{grid.svg}", "--sample-sketch", "{grid.svg}"]
    words = ["-o", "{two.png}", "--size", "80", "--pattern", "{above.png}", "--json"]
    assert run(folder, "sketch", "{cells.svg}", *samples, *words) == 0
    told = facts(capsys)["kinds"]
    assert [kind["sample"] for kind in told] == ["squares.png", "negative.png"]
    assert [kind["colour"] for kind in told] == ["#000000", "#ff0000"]
    shown = pixels(folder / "two.png")
    assert shown[:30].mean() < 128 < shown[-30:].mean()


def test_several_sketches_together(folder: Path, capsys: Captured) -> None:
    ways = {"one": [], "both": ["--sketch", "{grid.svg}"], "all": ["--sketch", "{grid.svg}", "--sketch", "random"]}
    found, shown = {}, {}
    for name, words in ways.items():
        words = [*words, "--size", "60", "--json"]
        assert run(folder, "sketch", "{cells.svg}", "{squares.png}", "-o", "{s.png}", *words) == 0
        found[name], shown[name] = facts(capsys), pixels(folder / "s.png")
    assert [found[name]["sketch"] for name in ways] == ["cells.svg"] * 3  # it tiles: no crop is better
    assert (shown["one"] != shown["both"]).any() and (shown["both"] != shown["all"]).any()


@pytest.mark.parametrize("tileable", [False, True])
def test_the_mesh_alone_is_read_again(folder: Path, tileable: bool, capsys: Captured) -> None:
    words = ["--mesh-only", "--size", "150x110", "--scale", "0.8", "--json", *["--tileable"] * tileable]
    assert run(folder, "sketch", "{cells.svg}", "-o", "{m.svg}", *words) == 0
    told = facts(capsys)
    sketch, _ = read_sketch(folder / "cells.svg")
    mesh = TextureMesh(size=(110, 150), scale=0.8, radius=told["radius"], tileable=tileable).run(sketch, 0)
    again, mends = read_sketch(folder / "m.svg")
    assert again.size == (110, 150) and not mends
    ours, theirs = mesh.cells(), again.cells()
    inside = ((ours.centroid > 0) & (ours.centroid < (109, 149))).all(axis=1)
    assert inside.sum() > 40
    away, which = KDTree(theirs.centroid).query(ours.centroid[inside])
    assert away.max() < 0.5
    np.testing.assert_allclose(theirs.area[which], ours.area[inside], rtol=0.03)


def test_the_mesh_alone_for_a_sample_has_cells_of_its_size(folder: Path, capsys: Captured) -> None:
    words = ["--mesh-only", "--size", "96", "--sample-sketch", "{grid.svg}", "--json"]
    assert run(folder, "sketch", "random", "{squares.png}", "-o", "{r.svg}", *words) == 0
    area = read_sketch(folder / "r.svg")[0].cells().area
    assert np.median(area) == pytest.approx(SQUARE**2, rel=0.1)


def test_mends_are_told_with_their_places(folder: Path, capsys: Captured) -> None:
    text = (folder / "grid.svg").read_text()
    (folder / "short.svg").write_text(text.replace("L72.0000 36.0000", "L70.0000 36.0000"))
    words = ["-o", "{t.png}", "--size", "40"]
    assert run(folder, "sketch", "{short.svg}", "{squares.png}", *words, "--json") == 0
    assert facts(capsys)["mends"] == ["short.svg: closed a gap of 2 texels at row 36, column 70"]
    assert run(folder, "sketch", "{short.svg}", "{squares.png}", *words) == 0
    assert "short.svg: closed a gap of 2 texels at row 36" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["{none.svg}", "{squares.png}"], "none.svg: no such file"),
        (["{cells.svg}", "{none.png}"], "none.png: no such file"),
        (["{empty.svg}", "{squares.png}"], "empty.svg holds no strokes"),
        (["{rings.svg}", "{squares.png}"], "rings.svg: the drawing's elements overlap"),
        (["{cells.svg}"], "a texture needs a sample: give one or more after the sketch, or add --mesh-only"),
        (["{cells.svg}", "{squares}"], "bad.png is one file, but there are 2 maps"),
        (["{cells.svg}", "{squares.png}", "--kinds", "{kinds.png}"], "--kinds kinds.png tells cells apart"),
        (["{cells.svg}", "{squares.png}", "--pattern", "{halves.png}"], "--pattern halves.png needs kinds"),
        (["{cells.svg}", "{squares.png}", "{squares.png}", "--kinds", "{kinds.png}", "--pattern", "{halves.png}"],
         "--kinds kinds.png is for one sample, but of 2 each is a kind"),
        (["{cells.svg}", "{squares.png}", "{squares.png}", "--sample-sketch", "{grid.svg}"],
         "--sample-sketch grid.svg: drawings of cells: 1, samples: 2; give one each, or none"),
        (["{cells.svg}", "{squares.png}", "--mesh-only"], "bad.png: --mesh-only writes a drawing, name it .svg"),
        (["{cells.svg}", "{squares.png}", "--inside", "out"], "unknown inside 'out': choose radial or scale"),
        (["{cells.svg}", "{squares.png}", "--preset", "texton"], "unknown preset 'texton': choose sketch"),
        (["{cells.svg}", "{squares.png}", "--scale", "0"], "--scale 0"),
        (["{cells.svg}", "{squares.png}", "--radius", "-1"], "--radius -1: texels, 0 or more"),
        (["{cells.svg}", "{squares.png}", "--radius", "inf"], "--radius inf: texels, 0 or more, and finite"),
        (["{cells.svg}", "{squares.png}", "--scale", "inf"], "--scale inf"),
        (["{cells.svg}", "{squares.png}", "--scale", "1e-9"], "at scale 1e-09, for a texture of 512×512: choose"),
        (["{cells.svg}", "{squares.png}", "--scale", "1e9"], "choose a scale between 0.05 and 4.1e+02"),
        (["{beside.svg}", "{squares.png}"], "beside.svg: nothing is drawn on the page of 200×200"),
        (["{cells.svg}", "{squares.png}", "--mask", "{comb.png}"], "masked texels lie in each of the sample's"),
        (["{cells.svg}", "{squares.png}", "--size", "wide"], "--size 'wide' is not W or WxH"),
    ],
)  # fmt: skip
def test_bad_input_is_one_line(folder: Path, words: list[str], message: str, capsys: Captured) -> None:
    assert run(folder, "sketch", *words, "-o", "{bad.png}") == 2
    out, err = capsys.readouterr()
    assert out == "" and err.startswith("texloom: ") and err.count("\n") == 1 and message in err
    assert not (folder / "bad.png").exists()


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["random"], "random cells are as large as a sample's: give a SAMPLE"),
        (["{cells.svg}", "--pattern", "{halves.png}"], "is for a texture, and --mesh-only makes none"),
        (["{cells.svg}", "--mask", "{kinds.png}"], "is for a sample, and there is none"),
    ],
)
def test_a_mesh_alone_refuses_what_is_for_textures(
    folder: Path, words: list[str], message: str, capsys: Captured
) -> None:
    assert run(folder, "sketch", *words, "--mesh-only", "-o", "{bad.svg}") == 2
    assert message in capsys.readouterr().err and not (folder / "bad.svg").exists()
    assert run(folder, "sketch", "{cells.svg}", "{squares.png}", "-o", "{bad.svg}") == 2
    assert "add --mesh-only" in capsys.readouterr().err


@pytest.mark.parametrize("method", ["optimize", "sweep"])
def test_cells_are_carried_over_a_surface(folder: Path, method: str, capsys: Captured) -> None:
    words = ["--sketch", "{cells.svg}", "--repeats", "0.5", "--method", method, "--sources", "{b.npz}", "--json"]
    assert run(folder, "surface", "{ball.obj}", "{squares}", "-o", "{b.glb}", "--as", "atlas", *words) == 0
    assert facts(capsys)["maps"] == ["basecolor", "height"] and (folder / "b.glb").stat().st_size > 1000
    saved = load_sources(folder / "b.npz")
    assert saved.settings["sketch"] == "cells.svg"
    assert saved.domain["sample"].tolist() == [SIDE, SIDE]  # of the original, not of what was designed
    turn = saved.sources.turn
    assert saved.sources.position.max() > SIDE / 2 and turn is not None and np.ptp(turn) > 0.1
    assert run(folder, "apply", "{b.npz}", "{squares}", "-o", "{b}") == 0
    assert {path.name for path in (folder / "b").iterdir()} == {"basecolor.png", "height.png"}


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["--method", "texton"], "is not for --method texton: leave it out"),
        (["--fuse", "{halves.png}"], "--fuse and --sketch"),
        (["--sketch", "{none.svg}"], "none.svg: no such file"),
        (["--sample-sketch", "{grid.svg}", "--sample-sketch", "{grid.svg}"], "drawings of cells: 2, samples: 1"),
        (["--radius", "-1"], "--radius -1: texels, 0 or more"),
    ],
)
def test_surfaces_refuse_what_does_not_go(folder: Path, words: list[str], message: str, capsys: Captured) -> None:
    start = ["surface", "{ball.obj}", "{squares.png}", "-o", "{bad.glb}", "--sketch", "{cells.svg}"]
    assert run(folder, *start, *words) == 2
    assert message in capsys.readouterr().err and not (folder / "bad.glb").exists()


def test_cells_of_a_surface_stray_and_are_drawn_as_asked(folder: Path, capsys: Captured) -> None:
    grown = {}
    for radius in ("0", "12"):
        words = ["--sketch", "{cells.svg}", "--sample-sketch", "{grid.svg}", "--radius", radius, "--sources", "{r.npz}"]
        assert run(folder, "surface", "{ball.obj}", "{squares}", "-o", "{r.ply}", "--repeats", "0.5", *words) == 0
        grown[radius] = load_sources(folder / "r.npz")
        assert float(grown[radius].settings["radius"]) == float(radius)
        assert grown[radius].settings["sample_sketch"] == "grid.svg"
    assert not np.array_equal(grown["0"].sources.position, grown["12"].sources.position)
    capsys.readouterr()
    for words, message in {("--radius", "3"): "--radius 3.0", ("--sample-sketch", "{grid.svg}"): "grid.svg"}.items():
        assert run(folder, "surface", "{ball.obj}", "{squares.png}", "-o", "{bad.glb}", *words) == 2
        assert f"{message} is for cells that are laid: add --sketch SKETCH" in capsys.readouterr().err


@needs_data
@pytest.mark.parametrize("name", sorted(path.name for path in (DATA / "sketches").glob("*.*")))
def test_every_sketch_becomes_a_texture(folder: Path, name: str) -> None:
    words = ["--sample-sketch", "{grid.svg}", "-o", "{every.png}", "--size", "64"]
    (folder / "every.png").unlink(missing_ok=True)
    assert run(folder, "sketch", str(DATA / "sketches" / name), "{squares.png}", *words) == 0
    lines = (pixels(folder / "every.png") < 50).all(axis=2).mean()
    assert 0.05 < lines < 0.7
