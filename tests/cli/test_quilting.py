"""``texloom surface --method texton``: every option, every way home, and one line where something is wrong."""

import json
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image

from tests.output.test_report import Page
from tests.output.test_sample_uv import attributes_of
from tests.output.test_textured import animated_glb
from texloom.cli import main as command
from texloom.demo import write_sample
from texloom.demo.polygonise import polygonise
from texloom.demo.shapes import ball
from texloom.demo.write import write_obj
from texloom.mesh.gltf import unpack

Captured = pytest.CaptureFixture[str]
SIDE = 48
MAPS = {"basecolor", "normal", "roughness", "metallic", "height", "ao"}


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A small ball, a small sample and its textons."""
    folder = tmp_path_factory.mktemp("quilting")
    write_sample(folder / "weave", "weave", size=SIDE)
    write_obj(
        folder / "ball.obj", polygonise(ball((0, 0, 0), 1.0), low=np.full(3, -1.3), high=np.full(3, 1.3), step=0.3)
    )
    assert command.main(["textons", str(folder / "weave"), "-o", str(folder / "weave.textons")]) == 0
    return folder


def run(folder: Path, *words: object, mesh: str = "ball.obj", sample: str = "weave.textons") -> int:
    paths = str(folder / mesh), str(folder / sample)
    return command.main(["surface", *paths, *map(str, words), *([] if "--preset" in words else ["--method", "texton"])])


def facts_of(folder: Path, capsys: Captured, *words: object, **inputs: str) -> dict[str, Any]:
    """What a run that must succeed tells."""
    capsys.readouterr()
    assert run(folder, *words, "--json", **inputs) == 0
    out, err = capsys.readouterr()
    assert not err
    return json.loads(out)


def sides(corners: np.ndarray) -> np.ndarray:
    """Lengths of the edges of faces."""
    return np.linalg.norm(np.roll(corners, 1, axis=1) - corners, axis=2)


def places(path: Path) -> np.ndarray:
    """[column, row] texels of the corners of all faces."""
    return attributes_of(path)[0]["TEXCOORD_0"].reshape(-1, 3, 2) * SIDE - 0.5


def told_once(folder: Path, capsys: Captured) -> str:
    """The one line on stderr of a command that failed and wrote nothing."""
    out, err = capsys.readouterr()
    assert out == "" and err.startswith("texloom: ") and err.count("\n") == 1
    assert not list(folder.glob("no*")), "something was written"
    return err


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["--search", "pca"], "--search pca is not for --method texton"),
        (["--fuse", "vertex"], "--fuse vertex is not for --method texton"),
        (["--analysis", "a.npz"], "--analysis a.npz is not for --method texton"),
        (["--mask", "m.png"], "--mask is for samples, weave.textons is learnt already: learn it with --mask"),
        (["--directx-normals"], "--directx-normals is for samples, weave.textons is learnt already"),
        (["--sources", "{out}.npz"], "--as sample-uv exchange the images of no.glb instead, or give --as atlas"),
        (["--repeats", 12], "of 396 patches, up to"),
        (["--patch", -1], "--patch"),
        (["--rounds", -1], "--rounds"),
        (["--blend", -1], "--blend"),
        (["--distance", 0], "a viewer 0.0 away"),
        (["--symmetry", 3], "symmetry 3 is not offered: choose 1, 2, 4 or 6"),
        (["--edges", "{out}.gif"], "--edges no.gif: a picture, name it .png"),
        (["--edges", "nowhere/e.png"], "there is no folder nowhere"),
        (["--preview", "{out}.txt"], "--preview no.txt: a picture, name it .png"),
        (["--report", "{out}.pdf"], "--report no.pdf"),
        (["--preset", "texton", "--patch", 8], "--preset texton quilts every face alone, once"),
        (["--preset", "texton", "--rounds", 1], "--preset texton quilts every face alone, once"),
        (["--preset", "texton", "--method", "optimize"], "--preset texton has no optimize"),
        (["--preset", "resampling", "--method", "texton"], "texton"),
    ],
)
def test_mistakes_are_told_in_one_line(folder: Path, words: list[Any], message: str, capsys: Captured) -> None:
    given = [str(word).replace("{out}", str(folder / "no")) for word in words]
    assert run(folder, "-o", folder / "no.glb", *given) == 2
    assert message in told_once(folder, capsys)


@pytest.mark.parametrize("option", ["patch", "rounds", "blend", "distance"])
def test_options_of_quilting_are_for_no_other_method(folder: Path, option: str, capsys: Captured) -> None:
    words = [folder / "ball.obj", folder / "weave", "-o", folder / "no.glb", f"--{option}", 1]
    assert command.main(["surface", *map(str, words)]) == 2
    assert f"--{option} 1" in told_once(folder, capsys)


def test_textons_are_for_no_other_method_and_stand_alone(folder: Path, capsys: Captured) -> None:
    textons, sample = folder / "weave.textons", folder / "weave"
    for words, message in (
        ([textons], "weave.textons is for --method texton: add it, or give the sample itself"),
        ([sample, textons, "--method", "texton"], "weave.textons holds its own sample: give it alone"),
        ([textons, textons, "--method", "texton"], "weave.textons holds its own sample: give it alone"),
    ):
        line = ["surface", folder / "ball.obj", *words, "-o", folder / "no.glb"]
        assert command.main([str(word) for word in line]) == 2
        assert message in told_once(folder, capsys)


def test_a_ball_lies_on_its_sample(folder: Path, capsys: Captured) -> None:
    out = folder / "a.glb"
    facts = facts_of(folder, capsys, "-o", out, "--repeats", 1)
    assert (facts["as"], facts["uv"], facts["method"]) == ("sample-uv", "sample, 48×48", "texton")
    assert facts["files"] == [str(out)] and set(facts["maps"]) == MAPS and facts["dropped"] == []
    assert facts["energy"][0] > facts["energy"][-1] and len(facts["energy"]) == 3
    assert 1 < facts["patches"] < facts["faces"] and facts["split"] == 0
    attributes, document = attributes_of(out)
    at = places(out)
    assert len(at) == facts["faces"] and at.min() > -0.5 and at.max() < SIDE - 0.5
    # The file says of every edge what the viewer makes of it.
    pixels = 1024 / np.radians(45) / facts["viewer distance"]
    shown = attributes["_BLEND"].reshape(-1, 3, 3)[:, 0] * pixels > 150
    assert shown.sum() == 2 * facts["blended edges"] and 0 < facts["blended edges"] < facts["edges"]
    assert document.json["asset"]["extras"]["texloom"]["mesh"] == "ball.obj"


def test_saved_textons_are_the_sample(folder: Path) -> None:
    """Learnt now or before, and whatever the number of threads: the same bytes. Another seed is another quilt."""
    written = {}
    for name, sample, words in (
        ("saved", "weave.textons", ["--threads", 1]),
        ("again", "weave.textons", ["--threads", 2]),
        ("learnt", "weave", []),
        ("other", "weave", ["--seed", 1]),
    ):
        out = folder / f"{name}.glb"
        assert run(folder, "-o", out, "--repeats", 1, *words, sample=sample) == 0
        written[name] = out.read_bytes()
    assert written["saved"] == written["again"]
    saved, learnt, other = (unpack(written[name]) for name in ("saved", "learnt", "other"))
    assert saved.binary == learnt.binary != other.binary
    told = [document.json["asset"]["extras"]["texloom"].pop("sample") for document in (saved, learnt)]
    assert told == ["weave.textons", "weave"] and saved.json == learnt.json


def test_patches_and_rounds(folder: Path, capsys: Captured) -> None:
    def told(*words: object) -> dict[str, Any]:
        return facts_of(folder, capsys, "-o", folder / "b.glb", "--repeats", 1, *words)

    usual, once, small, alone = told(), told("--rounds", 0), told("--patch", 10), told("--patch", 0)
    assert alone["patches"] == alone["faces"] > small["patches"] > usual["patches"]
    # A face alone lies there as it is: its sides are as many texels long.
    corners = attributes_of(folder / "b.glb")[0]["POSITION"].reshape(-1, 3, 3)
    np.testing.assert_allclose(sides(places(folder / "b.glb")) * alone["texel"], sides(corners), rtol=1e-3)
    assert len(once["energy"]) == 1 and once["energy"][0] == usual["energy"][0]
    assert usual["edge error"] <= once["edge error"] and usual["edge error"] < alone["edge error"]
    published = told("--preset", "texton")
    assert published["patches"] == published["faces"] and len(published["energy"]) == 1
    assert published["edge error"] > alone["edge error"] and published["preset"] == "texton"


def test_blending_follows_the_viewer(folder: Path, capsys: Captured) -> None:
    def blended(*words: object) -> int:
        return facts_of(folder, capsys, "-o", folder / "b.glb", "--repeats", 1, *words)["blended edges"]

    near, far = blended("--distance", 2), blended("--distance", 200)
    assert near == blended("--distance", 4, "--blend", 75) > blended("--distance", 4) > far
    assert blended("--blend", "inf") == 0 < blended("--blend", 0)


def test_fields_turn_and_scale(folder: Path, capsys: Captured) -> None:
    (folder / "arrows.json").write_text('[{"point": [0, 0, 1], "direction": [0, 1, 0], "scale": 2}]')
    sizes = {}
    for name, words in (
        ("usual", []),
        ("larger", ["--scale", folder / "arrows.json"]),
        ("uniform", ["--scale", folder / "arrows.json", "--uniform"]),
        ("texel", ["--texel", 2 * 2 / SIDE]),
        ("turned", ["--direction", "0,1,0", "--symmetry", 4]),
    ):
        facts = facts_of(
            folder, capsys, "-o", folder / f"{name}.glb", *(words if name == "texel" else [*words, "--repeats", 1])
        )
        at = places(folder / f"{name}.glb")
        sizes[name] = float(sides(at).mean()), facts
    assert sizes["uniform"][0] == pytest.approx(sizes["usual"][0], rel=0.02)
    assert sizes["larger"][0] == pytest.approx(sizes["usual"][0] / 2, rel=0.05)
    assert sizes["texel"][0] == pytest.approx(sizes["usual"][0] / 2, rel=0.05)
    assert sizes["texel"][1]["texel"] == pytest.approx(4 / SIDE)
    told = unpack((folder / "turned.glb").read_bytes()).json["asset"]["extras"]["texloom"]
    assert told["symmetry"] == "4" and told["direction"] == "0,1,0"
    assert not np.allclose(places(folder / "turned.glb"), places(folder / "usual.glb"), atol=1)


def test_an_atlas_is_baked_and_its_sources_apply(folder: Path, capsys: Captured) -> None:
    words = ["-o", folder / "c.obj", "--as", "atlas", "--repeats", 1, "--atlas-size", 128]
    facts = facts_of(folder, capsys, *words, "--sources", folder / "c.npz")
    assert facts["uv"] == "fresh atlas, 128×128"
    assert command.main(["apply", str(folder / "c.npz"), str(folder / "weave"), "-o", str(folder / "again")]) == 0
    for name in MAPS:
        first, second = folder / f"c-{name}.png", folder / "again" / f"{name}.png"
        np.testing.assert_array_equal(np.asarray(Image.open(first)), np.asarray(Image.open(second)), name)
    sharp = facts_of(folder, capsys, "-o", folder / "d.obj", *words[2:], "--blend", "inf")
    assert sharp["blended edges"] == 0
    assert np.any(
        np.asarray(Image.open(folder / "c-basecolor.png")) != np.asarray(Image.open(folder / "d-basecolor.png"))
    )


def test_vertex_colours_and_their_sources_score_alike(folder: Path, capsys: Captured) -> None:
    words = ["-o", folder / "e.glb", "--as", "vertex", "--repeats", 1, "--sources", folder / "e.npz"]
    assert facts_of(folder, capsys, *words)["files"] == [str(folder / "e.glb"), str(folder / "e.npz")]
    tables = []
    for name in ("e.glb", "e.npz"):
        assert command.main(["score", str(folder / "weave"), str(folder / name), "--json"]) == 0
        tables.append(json.loads(capsys.readouterr().out)["scores"])
    for name in MAPS:
        assert 0.6 < tables[0][name].pop("copy") / tables[1][name].pop("copy") < 1.2  # pieces are found but for rims
        assert tables[0][name] == pytest.approx(tables[1][name], rel=0.02, abs=0.02)


def test_what_cannot_be_scored_says_what_can(folder: Path, capsys: Captured) -> None:
    assert run(folder, "-o", folder / "f.glb", "--repeats", 1) == 0
    assert run(folder, "-o", folder / "g.glb", "--as", "atlas", "--atlas-size", 64, "--sources", folder / "g.npz") == 0
    capsys.readouterr()
    for name, what in (
        ("f.glb", "f.glb shows the sample itself"),
        ("g.npz", "g.npz holds what the texels of an atlas"),
    ):
        assert command.main(["score", str(folder / "weave"), str(folder / name)]) == 2
        told = told_once(folder, capsys)
        assert what in told and "texture the mesh --as vertex and score that .glb" in told


def test_large_faces_are_split_where_a_picture_is_baked(folder: Path, capsys: Captured) -> None:
    (folder / "four.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n")
    words = ["--repeats", 3, "-o", folder / "no.glb"]
    assert run(folder, *words, mesh="four.obj") == 2
    assert re.search(r"4 of 4 patches, up to \d+x\d+ texels, have no place", told_once(folder, capsys))
    for home in ("atlas", "vertex"):
        facts = facts_of(folder, capsys, "--repeats", 3, "-o", folder / "h.glb", "--as", home, mesh="four.obj")
        assert facts["faces"] == 4 and facts["split"] > 4 and facts["as"] == home


def test_pictures_and_a_page(folder: Path, capsys: Captured) -> None:
    preview, edges, page = folder / "p.png", folder / "q.png", folder / "r.html"
    words = ["--preview", preview, "--edges", edges, "--report", page, "--repeats", 1]
    facts = facts_of(folder, capsys, "-o", folder / "i.glb", *words)
    assert facts["files"] == [str(folder / "i.glb"), str(preview), str(edges), str(page)]
    assert np.asarray(Image.open(preview)).std() > 10 and np.asarray(Image.open(edges)).std() > 10
    told = Page(page.read_text(encoding="utf-8"))
    assert {"Sample", "Result", "Edges", "swd", "coherence", "completeness"} <= set(told.text)
    assert any(f"{facts['faces']} faces in {facts['patches']} patches" in text for text in told.text)


def test_two_samples_are_one_vocabulary(folder: Path, capsys: Captured) -> None:
    """Sizes are those of the first; a face shows one of them, and never the gap between."""
    words = ["surface", folder / "ball.obj", folder / "weave", folder / "weave", "--method", "texton", "--repeats", 1]
    shown = np.zeros(2, bool)
    for seed in range(4):
        assert command.main([*map(str, words), "-o", str(folder / "two.glb"), "--json", "--seed", str(seed)]) == 0
        facts = json.loads(capsys.readouterr().out)
        columns, rows = (int(side) for side in facts["uv"].removeprefix("sample, ").split("×"))
        at = attributes_of(folder / "two.glb")[0]["TEXCOORD_0"].reshape(-1, 3, 2) * [columns, rows] - 0.5
        first = (at < SIDE).all((1, 2))
        second = (at.reshape(-1, 3, 2) >= [columns - SIDE - 0.5, rows - SIDE - 0.5]).all((1, 2))
        assert (first ^ second).all()
        shown |= [first.any(), second.any()]
    assert shown.all()
    assert facts["texel"] == facts_of(folder, capsys, "-o", folder / "a.glb", "--repeats", 1)["texel"]


def test_a_masked_sample(folder: Path, capsys: Captured) -> None:
    white = np.zeros((SIDE, SIDE), np.uint8)
    white[:, :30] = 255
    Image.fromarray(white).save(folder / "mask.png")
    facts_of(folder, capsys, "-o", folder / "j.glb", "--repeats", 1, "--mask", folder / "mask.png", sample="weave")
    assert places(folder / "j.glb")[..., 0].max() < 30


def test_a_glb_goes_back_with_its_nodes(folder: Path, capsys: Captured) -> None:
    before = unpack(animated_glb(folder / "in.glb"))
    facts = facts_of(folder, capsys, "-o", folder / "out.glb", "--repeats", 1, "--material", "hide", mesh="in.glb")
    assert facts["faces"] == 16
    attributes, after = attributes_of(folder / "out.glb")
    assert {"JOINTS_0", "WEIGHTS_0", "TANGENT", "_UV_A", "_UV_B", "_UV_C", "_BARY", "_BLEND"} <= set(attributes)
    for kind in ("animations", "skins", "scenes"):
        assert after.json[kind] == before.json[kind]
    assert [node["name"] for node in after.json["nodes"] if "name" in node] == ["first", "bone"]
    assert after.json["materials"][:2] == before.json["materials"]
