"""Surfaces are scored from their GLB, or from their sources, with the same numbers."""

import json
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from texloom.cli import main as command
from texloom.cli.painted import from_glb, from_sources, score_painted
from texloom.demo import draw
from texloom.demo.polygonise import polygonise
from texloom.demo.shapes import ball
from texloom.demo.write import write_obj
from texloom.errors import ParameterError
from texloom.io.stack import read_exemplar
from texloom.mesh.gltf import Document, pack, unpack
from texloom.output.image import write_images
from texloom.output.sources_file import load_sources

Captured = pytest.CaptureFixture[str]


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A ball with a coat of lines, as vertex colours and as an atlas, and its sources."""
    folder = tmp_path_factory.mktemp("painted")
    write_images(folder / "weave", {name: draw("weave", size=48).maps[name] for name in ("basecolor", "normal")})
    write_obj(
        folder / "ball.obj", polygonise(ball((0, 0, 0), 1.0), low=np.full(3, -1.3), high=np.full(3, 1.3), step=0.3)
    )
    (folder / "arrows.json").write_text('[{"point": [0,0,1], "direction": [0,1,0], "scale": 1.3}]')
    grow = ["surface", folder / "ball.obj", folder / "weave", "--repeats", 2, "--direction", folder / "arrows.json"]
    for words in (["-o", folder / "a.glb", "--as", "vertex", "--symmetry", 2], ["-o", folder / "b.glb"]):
        out = folder / words[1].with_suffix(".npz").name
        assert command.main([*map(str, grow), *map(str, words), "--sources", str(out)]) == 0
    return folder


def test_a_glb_carries_its_surface(folder: Path) -> None:
    exemplar = read_exemplar(folder / "weave")
    glb = from_glb(folder / "a.glb", exemplar)
    kept = from_sources(load_sources(folder / "a.npz"), exemplar, "a.npz")
    assert glb.surface.count == kept.surface.count
    assert glb.surface.field.order == kept.surface.field.order == 2
    assert glb.surface.texel == pytest.approx(kept.surface.texel)
    np.testing.assert_allclose(glb.surface.scale, 1.3, rtol=1e-5)
    np.testing.assert_allclose(glb.surface.direction, kept.surface.direction, atol=1e-4)
    for name in exemplar.maps:
        np.testing.assert_allclose(glb.values[name][:, :3], kept.values[name], atol=1e-4)


def test_scores_do_not_depend_on_the_file(folder: Path, capsys: Captured) -> None:
    tables = []
    for name in ("a.glb", "a.npz"):
        assert command.main(["score", str(folder / "weave"), str(folder / name), "--json"]) == 0
        tables.append(json.loads(capsys.readouterr().out)["scores"])
    assert list(tables[0]) == ["basecolor", "normal"]
    assert list(tables[0]["basecolor"]) == ["swd", "coherence", "completeness", "copy"]
    for name, scores in tables[0].items():
        by_colours, by_sources = scores.pop("copy"), tables[1][name].pop("copy")
        assert scores == pytest.approx(tables[1][name], rel=0.02, abs=0.02)
        assert 0.5 * by_sources < by_colours < 1.2 * by_sources


def test_the_own_sample_scores_best(folder: Path) -> None:
    """Grown from a weave, a surface is more like a weave than like bricks."""
    painted = from_glb(folder / "a.glb", read_exemplar(folder / "weave"))
    own = score_painted(read_exemplar(folder / "weave"), painted)["basecolor"]
    other = score_painted(draw("bricks", size=48), painted)["basecolor"]
    for name in ("swd", "coherence", "completeness"):
        assert own[name] < 0.5 * other[name], name
    assert own["copy"] > 1.2 * other["copy"]


def test_sources_on_an_atlas_score_too(folder: Path, capsys: Captured) -> None:
    assert command.main(["score", str(folder / "weave"), str(folder / "b.npz")]) == 0
    assert capsys.readouterr().out.splitlines()[0].split() == ["map", "swd", "coherence", "completeness", "copy"]


def test_sources_of_an_image_score_as_the_image(folder: Path, capsys: Captured) -> None:
    sample, image, sources = folder / "weave" / "basecolor.png", folder / "i.png", folder / "i.npz"
    grow = ["image", sample, "-o", image, "--size", 40, "--sources", sources]
    assert command.main([str(word) for word in grow]) == 0
    capsys.readouterr()
    tables = []
    for result in (image, sources):
        assert command.main(["score", str(sample), str(result)]) == 0
        tables.append(capsys.readouterr().out)
    assert tables[0] == tables[1]


@pytest.mark.parametrize(
    ("result", "message"),
    [
        (
            "b.glb",
            "b.glb carries no vertex colours: score the .glb that --as vertex writes, or the file that --sources",
        ),
        ("ball.obj", "ball.obj is a mesh without a direction field: score the .glb"),
        ("bare.glb", "bare.glb carries no direction field: score"),
        ("texel.glb", "texel.glb does not say how long a texel is"),
        ("other.npz", "other.npz was made from a sample of 48x48 texels, but the stack is 48x40"),
        ("missing.glb", "missing.glb: no such file"),
    ],
)
def test_a_result_without_a_field_is_refused(folder: Path, result: str, message: str, capsys: Captured) -> None:
    document = unpack((folder / "a.glb").read_bytes())
    if result == "bare.glb":
        del document.json["meshes"][0]["primitives"][0]["attributes"]["TANGENT"]
    if result == "texel.glb":
        del document.json["meshes"][0]["extras"]
    if result in ("bare.glb", "texel.glb"):
        (folder / result).write_bytes(pack(Document(document.json, document.binary)))
    sample = folder / "weave"
    if result == "other.npz":
        (folder / result).write_bytes((folder / "a.npz").read_bytes())
        sample = folder / "cut.png"
        Image.open(folder / "weave" / "basecolor.png").crop((0, 0, 48, 40)).save(sample)
    assert command.main(["score", str(sample), str(folder / result)]) == 2
    out, err = capsys.readouterr()
    assert not out and err.startswith("texloom: ") and err.count("\n") == 1
    assert message in err


def test_no_map_in_common(folder: Path) -> None:
    exemplar = read_exemplar(folder / "weave")
    painted = from_glb(folder / "a.glb", exemplar)
    painted.values.clear()
    with pytest.raises(ParameterError, match="no map in common"):
        score_painted(exemplar, painted)
