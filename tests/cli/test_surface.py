"""``texloom surface`` and the options that only it has."""

import json
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from texloom.cli import main as command
from texloom.demo import write_sample
from texloom.demo.polygonise import polygonise
from texloom.demo.shapes import ball
from texloom.demo.write import write_obj

Captured = pytest.CaptureFixture[str]


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A small ball and a small sample."""
    folder = tmp_path_factory.mktemp("surface")
    write_sample(folder / "weave", "weave", size=48)
    write_obj(
        folder / "ball.obj", polygonise(ball((0, 0, 0), 1.0), low=np.full(3, -1.3), high=np.full(3, 1.3), step=0.3)
    )
    return folder


def run(folder: Path, *words: object) -> int:
    return command.main(["surface", str(folder / "ball.obj"), str(folder / "weave"), *map(str, words)])


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["-o", "a.glb", "--repeats", 2, "--texel", 0.1], "--repeats and --texel both set the size"),
        (["-o", "a.png"], "a.png: --as atlas is written as .glb or .obj"),
        (["-o", "a.ply", "--as", "atlas"], "a.ply: --as atlas is written as .glb or .obj"),
        (["-o", "a.obj", "--as", "vertex"], "a.obj: --as vertex is written as .glb or .ply"),
        (["-o", "a.glb", "--as", "voxels"], "unknown home 'voxels': choose vertex, atlas or sample-uv"),
        (["-o", "a.glb", "--texel", "-1"], "a texel of -1 world units"),
        (["-o", "a.glb", "--symmetry", "3"], "symmetry 3 is not offered: choose 1, 2, 4 or 6"),
        (["-o", "a.glb", "--direction", "1,2"], "a vector has 3 numbers"),
        (["-o", "a.glb", "--direction", "arrows.json"], "arrows.json cannot be read: No such file"),
        (["-o", "a.glb", "--scale", "scale.npy"], "scale.npy cannot be read: No such file"),
        (["-o", "a.glb", "--material", "fur"], "no material 'fur'"),
        (["-o", "a.glb", "--preview", "nowhere/a.png"], "there is no folder nowhere"),
    ],
)
def test_bad_options_are_one_line(folder: Path, words: list[object], message: str, capsys: Captured) -> None:
    assert run(folder, *words) == 2
    out, err = capsys.readouterr()
    assert out == "" and err.startswith("texloom: ") and err.count("\n") == 1
    assert message in err
    assert not Path("a.glb").exists()


def test_a_ball_is_textured(folder: Path, capsys: Captured) -> None:
    words = ["-o", folder / "a.glb", "--repeats", 1, "--preview", folder / "a.png", "--atlas-size", 64, "--json"]
    assert run(folder, *words) == 0
    facts = json.loads(capsys.readouterr().out)
    assert facts["uv"] == "fresh atlas, 64×64" and facts["as"] == "atlas"
    assert [Path(file).name for file in facts["files"]] == ["a.glb", "a.png"]
    assert (folder / "a.glb").read_bytes()[:4] == b"glTF"
    assert np.asarray(Image.open(folder / "a.png")).std() > 10


def test_sources_of_a_surface_apply_on_its_atlas(folder: Path, capsys: Captured) -> None:
    words = ["-o", folder / "b.obj", "--repeats", 1, "--atlas-size", 64, "--sources", folder / "b.npz"]
    assert run(folder, *words) == 0
    assert command.main(["apply", str(folder / "b.npz"), str(folder / "weave"), "-o", str(folder / "again")]) == 0
    for name in ("basecolor", "normal"):
        first, second = folder / f"b-{name}.png", folder / "again" / f"{name}.png"
        np.testing.assert_array_equal(np.asarray(Image.open(first)), np.asarray(Image.open(second)))


def test_vertex_colours_follow_an_arrow(folder: Path, capsys: Captured) -> None:
    (folder / "arrows.json").write_text('[{"point": [0, 0, 1], "direction": [0, 1, 0]}]')
    words = ["-o", folder / "a.ply", "--repeats", 1, "--direction", folder / "arrows.json", "--json"]
    assert run(folder, *words) == 0
    assert json.loads(capsys.readouterr().out)["as"] == "vertex"
    assert (folder / "a.ply").read_bytes().startswith(b"ply")


def test_inspect_says_where_sources_lie(folder: Path, capsys: Captured) -> None:
    words = ["-o", folder / "c.glb", "--texel", 0.05, "--atlas-size", 64, "--sources", folder / "c.npz"]
    assert run(folder, *words) == 0
    capsys.readouterr()
    assert command.main(["inspect", str(folder / "c.npz"), "--json"]) == 0
    facts = json.loads(capsys.readouterr().out)
    assert facts["of"] == "a surface" and facts["texel"] == 0.05 and facts["atlas"] == [64, 64]
    (folder / "broken.npz").write_bytes((folder / "c.npz").read_bytes()[:5000])
    assert command.main(["inspect", str(folder / "broken.npz")]) == 2
    assert "broken.npz holds neither sources nor an analysis" in capsys.readouterr().err
