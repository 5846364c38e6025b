"""``texloom fuse``, and ``texloom surface`` with a fusion map."""

import json
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from tests.data import DATA, needs_data
from texloom.cli import main as command
from texloom.demo import write_sample
from texloom.demo.polygonise import polygonise
from texloom.demo.shapes import ball
from texloom.demo.write import write_obj

Captured = pytest.CaptureFixture[str]
RED, BLUE = (255, 0, 0), (0, 0, 255)


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Two samples, three maps, and a ball with and without colours at its vertices."""
    folder = tmp_path_factory.mktemp("fuse")
    for name in ("weave", "pebbles"):
        write_sample(folder / name, name, size=48)
        Image.open(folder / name / "basecolor.png").save(folder / f"{name}.png")
    (folder / "pebbles" / "ao.png").unlink()
    column = np.arange(60)[None].repeat(44, 0)
    Image.fromarray(np.where(column[..., None] < 30, RED, BLUE).astype(np.uint8)).save(folder / "map.png")
    Image.fromarray((column * 4).astype(np.uint8)).save(folder / "grey.png")
    faces = polygonise(ball((0, 0, 0), 1.0), low=np.full(3, -1.3), high=np.full(3, 1.3), step=0.3)
    write_obj(folder / "ball.obj", faces)
    lines = []
    for line in (folder / "ball.obj").read_text().splitlines():
        if line.startswith("v "):
            line += " 1 0 0" if float(line.split()[2]) > 0 else " 0 0 1"
        lines.append(line)
    (folder / "painted.obj").write_text("\n".join(lines))
    return folder


def fuse(folder: Path, wish: str, *words: object) -> int:
    samples = [str(folder / f"{name}.png") for name in ("weave", "pebbles")]
    return command.main(["fuse", wish, *samples, *map(str, words)])


def shares(capsys: Captured) -> list[float]:
    return [entry["share"] for entry in json.loads(capsys.readouterr().out)["samples"]]


@pytest.mark.parametrize("belts", ["cut", "sample"])
def test_a_map_sets_size_and_places(folder: Path, belts: str, capsys: Captured) -> None:
    assert fuse(folder, str(folder / "map.png"), "-o", folder / "a.png", "--belts", belts, "--json") == 0
    facts = json.loads(capsys.readouterr().out)
    assert facts["size"] == [60, 44] and Image.open(folder / "a.png").size == (60, 44)
    assert [entry["sample"] for entry in facts["samples"]] == ["weave.png", "pebbles.png"]
    assert [entry["colour"] for entry in facts["samples"]] == ["#ff0000", "#0000ff"]
    assert all(0.3 < entry["share"] < 0.7 for entry in facts["samples"])


def test_a_palette_turns_the_samples_around(folder: Path, capsys: Captured) -> None:
    words = ["-o", folder / "b.png", "--size", "90x66", "--json"]
    assert fuse(folder, str(folder / "map.png"), *words, "--sources", folder / "b.npz") == 0
    assert fuse(folder, str(folder / "map.png"), *words, "--palette", "blue,#f00", "--sources", folder / "c.npz") == 0
    one, other = (np.load(folder / f"{name}.npz")["position"].reshape(66, 90, 2) for name in "bc")
    parts = np.load(folder / "b.npz")["domain.parts"]
    assert len(parts) == 2 and parts[0][1] != parts[1][1]
    in_second = [places[..., 1] >= parts[1][1] for places in (one, other)]
    assert not in_second[0][:, :30].any() and in_second[0][:, 60:].all()
    assert in_second[1][:, :30].all() and not in_second[1][:, 60:].any()


def test_stacks_are_fused_and_sources_apply_again(folder: Path, capsys: Captured) -> None:
    stacks = [str(folder / "weave"), str(folder / "pebbles")]
    words = ["-o", folder / "out", "--sources", folder / "s.npz", "--report", folder / "r.html", "--tileable", "--json"]
    assert command.main(["fuse", str(folder / "map.png"), *stacks, *map(str, words)]) == 0
    told = capsys.readouterr()
    assert json.loads(told.out)["dropped"] == ["ao"] and "not all samples have it: ao" in told.err
    assert command.main(["apply", str(folder / "s.npz"), *stacks, "-o", str(folder / "again")]) == 0
    for name in ("basecolor", "normal"):
        first, second = (np.asarray(Image.open(folder / f / f"{name}.png")) for f in ("out", "again"))
        np.testing.assert_array_equal(first, second)
    assert "<html" in (folder / "r.html").read_text()


def test_discs_are_strewn(folder: Path, capsys: Captured) -> None:
    assert fuse(folder, "discs", "-o", folder / "d.png", "--size", "64x80", "--tileable", "--json") == 0
    assert 0.15 < shares(capsys)[0] < 0.75
    assert fuse(folder, str(folder / "grey.png"), "--discs", "-o", folder / "e.png", "--json") == 0
    assert 0.2 < shares(capsys)[0] < 0.8


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["nothing.png", "{a}", "{b}"], "nothing.png: no such file"),
        (["{m}", "{a}", "{b}", "{b}"], "the map has 2 colours, but there are 3 samples"),
        (["{m}", "{a}", "{b}", "--palette", "red"], "colours in the palette: 1, samples: 2"),
        (["{m}", "{a}", "{b}", "--palette", "rot,blau"], "--palette rot,blau: unknown color"),
        (["{m}", "{a}", "{b}", "--belts", "wide"], "unknown belts 'wide': choose cut or sample"),
        (["discs", "{a}", "{b}", "{b}"], "discs mix 2 samples, not 3"),
        (["{m}", "{a}", "{b}", "--method", "weave"], "unknown method 'weave'"),
    ],
)
def test_bad_input_is_one_line(folder: Path, words: list[str], message: str, capsys: Captured) -> None:
    places = {"a": folder / "weave.png", "b": folder / "pebbles.png", "m": folder / "map.png"}
    assert command.main(["fuse", *(word.format(**places) for word in words), "-o", str(folder / "bad.png")]) == 2
    out, err = capsys.readouterr()
    assert out == "" and err.startswith("texloom: ") and err.count("\n") == 1 and message in err
    assert not (folder / "bad.png").exists()


def surface(folder: Path, mesh: str, *words: object) -> int:
    samples = [str(folder / f"{name}.png") for name in ("weave", "pebbles")]
    return command.main(["surface", str(folder / mesh), *samples, "--repeats", "1", *map(str, words)])


@pytest.mark.parametrize(("mesh", "wish"), [("painted.obj", "vertex"), ("ball.obj", "{folder}/painted.obj")])
def test_vertex_colours_say_where_samples_go(folder: Path, mesh: str, wish: str, capsys: Captured) -> None:
    words = ["-o", folder / "a.glb", "--atlas-size", 64, "--sources", folder / "g.npz", "--json"]
    assert surface(folder, mesh, "--fuse", wish.format(folder=folder), *words) == 0
    facts = json.loads(capsys.readouterr().out)
    assert [entry["colour"] for entry in facts["samples"]] == ["#ff0000", "#0000ff"]
    saved = np.load(folder / "g.npz")
    second = saved["position"][:, 0, 1] >= saved["domain.parts"][1][1] - 1
    height = saved["domain.surface.vertices"][:, 1]
    assert not second[height > 0.6].any() and second[height < -0.6].all()
    stacks = [str(folder / f"{name}.png") for name in ("weave", "pebbles")]
    assert command.main(["apply", str(folder / "g.npz"), *stacks, "-o", str(folder / "g.png")]) == 0


def test_a_painted_texture_is_read_through_the_uvs(folder: Path, capsys: Captured) -> None:
    """A sheet whose u runs along y and whose v runs along x: what is painted low lies where x is small."""
    side = np.linspace(0, 1, 5)
    x, y = (axis.ravel() for axis in np.meshgrid(side, side, indexing="ij"))
    first = (np.arange(4)[:, None] * 5 + np.arange(4)).ravel() + 1
    lines = [f"v {a} {b} 0\nvt {b} {a}" for a, b in zip(x, y, strict=True)]
    lines += ["f " + " ".join(f"{k}/{k}" for k in (n, n + 5, n + 6, n + 1)) for n in first]
    (folder / "sheet.obj").write_text("\n".join(lines))
    row = np.arange(64)[:, None].repeat(40, 1)
    Image.fromarray(np.where(row[..., None] < 16, RED, BLUE).astype(np.uint8)).save(folder / "painted.png")
    words = ["-o", folder / "p.glb", "--fuse", folder / "painted.png", "--fresh-atlas", "--sources", folder / "p.npz"]
    assert surface(folder, "sheet.obj", *words) == 0
    saved = np.load(folder / "p.npz")
    second = saved["position"][:, 0, 1] >= saved["domain.parts"][1][1] - 1
    across = saved["domain.surface.vertices"][:, 0]
    assert not second[across > 0.9].any() and second[across < 0.6].all()


def test_samples_without_a_map_are_one_vocabulary(folder: Path, capsys: Captured) -> None:
    assert surface(folder, "ball.obj", "-o", folder / "v.ply", "--sources", folder / "v.npz", "--json") == 0
    saved = np.load(folder / "v.npz")
    share = np.mean(saved["position"][:, 0, 1] >= saved["domain.parts"][1][1])
    assert 0.02 < share < 0.98


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["--fuse", "vertex"], "ball.obj has no colours at its vertices"),
        (["--fuse", "{folder}/map.png"], "ball.obj has no UVs to read a painted map by"),
        (["--fuse", "nothing.ply"], "nothing.ply: no such file"),
        (["--palette", "red,blue"], "add --fuse MAP"),
        (["--fuse", "vertex", "--preset", "resampling"], "exclude each other"),
    ],
)
def test_maps_that_do_not_fit_a_surface(folder: Path, words: list[str], message: str, capsys: Captured) -> None:
    assert surface(folder, "ball.obj", "-o", folder / "no.glb", *(word.format(folder=folder) for word in words)) == 2
    out, err = capsys.readouterr()
    assert out == "" and err.count("\n") == 1 and message in err
    assert not (folder / "no.glb").exists()


@needs_data
@pytest.mark.parametrize("name", ["spot-vertex-2colour.ply", "two-colour-blobs-512.png"])
def test_real_maps_on_a_real_mesh(folder: Path, name: str, capsys: Captured) -> None:
    words = ["--fuse", DATA / "fusion" / name, "-o", folder / "spot.glb", "--atlas-size", 64, "--json"]
    assert surface(folder, str(DATA / "meshes" / "spot-3k.obj"), *words) == 0
    assert all(0.2 < share < 0.8 for share in shares(capsys))
