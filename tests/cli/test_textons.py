"""``texloom textons``: from a sample to a file that ``texloom inspect`` lists; nothing where something is wrong."""

import json
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from tests.data import DATA, needs_data
from tests.output.test_report import Page
from texloom.cli import main as command
from texloom.demo import write_sample
from texloom.output.textons_file import load_textons

Captured = pytest.CaptureFixture[str]


@pytest.fixture
def sample(tmp_path: Path) -> Path:
    write_sample(tmp_path / "weave", "weave", size=40)
    return tmp_path / "weave"


def run(*words: object) -> int:
    return command.main([str(word) for word in words])


def test_a_sample_becomes_one_file(sample: Path, capsys: Captured) -> None:
    out = sample.parent / "weave.textons"
    page, picture = out.with_suffix(".html"), out.with_suffix(".png")
    words = [
        "textons",
        sample,
        "-o",
        out,
        "--orientations",
        4,
        "--seed",
        3,
        "--report",
        page,
        "--map",
        picture,
        "--json",
    ]
    assert run(*words) == 0
    facts = json.loads(capsys.readouterr().out)
    assert facts["files"] == [str(out), str(picture), str(page)]
    assert (facts["sample"], facts["textons"], facts["orientations"], facts["seed"]) == ([40, 40], 40, 4, 3)
    assert facts["kept"] >= 0.99 and facts["window"] == 11 and facts["made"]["sample"] == "weave"
    textons = load_textons(out)
    assert set(textons.exemplar.maps) == set(facts["maps"]) and len(facts["maps"]) > 3
    assert np.asarray(Image.open(picture)).shape == (40, 40, 3)
    told = Page(page.read_text(encoding="utf-8"))
    assert "Texton map" in told.text and "Textons of weave" in told.text
    assert run("inspect", out, "--json") == 0
    inspected = json.loads(capsys.readouterr().out)
    assert {name: inspected[name] for name in inspected if name not in ("files", "seconds")} == {
        name: facts[name] for name in facts if name not in ("files", "seconds")
    }


def test_a_folder_of_them_is_a_library(sample: Path, tmp_path: Path, capsys: Captured) -> None:
    shelf = tmp_path / "shelf"
    shelf.mkdir()
    lead = sample / "basecolor.png"
    assert run("textons", lead, "-o", shelf / "b.textons", "--count", 9, "--orientations", 1) == 0
    assert run("textons", lead, "-o", shelf / "a.textons", "--features", "filters", "--orientations", 2) == 0
    (shelf / "broken.textons").write_bytes(b"PK")
    capsys.readouterr()
    assert run("inspect", shelf) == 0
    header, first, second, problem = capsys.readouterr().out.splitlines()
    assert header.split() == ["name", "sample", "maps", "textons", "features", "orientations", "kB"]
    assert first.split()[:4] == ["a.textons", "40×40", "basecolor", "40"] and "filters" in first
    assert second.split()[3:6] == ["9", "window", "11"] and problem.startswith("broken.textons is not a file")
    assert len(header) == len(first) == len(second)
    assert run("inspect", shelf, "--json") == 0
    library = json.loads(capsys.readouterr().out)["library"]
    assert [facts["name"] for facts in library] == ["a.textons", "b.textons", "broken.textons"]
    assert library[1]["textons"] == 9 and "problem" in library[2]


def test_a_stack_with_its_textons_inside_is_still_a_stack(sample: Path, capsys: Captured) -> None:
    assert run("textons", sample, "-o", sample / "weave.textons", "--orientations", 1) == 0
    capsys.readouterr()
    assert run("inspect", sample, "--json") == 0
    assert json.loads(capsys.readouterr().out)["kind"] == "stack"


def test_a_mask_and_green_down(sample: Path, tmp_path: Path, capsys: Captured) -> None:
    white = np.zeros((40, 40), np.uint8)
    white[:, :30] = 255
    Image.fromarray(white).save(tmp_path / "mask.png")
    kept = tmp_path / "a.textons"
    words = ["textons", sample, "-o", kept, "--orientations", 1, "--mask", tmp_path / "mask.png", "--directx-normals"]
    assert run(*words, "--json") == 0
    facts = json.loads(capsys.readouterr().out)
    assert facts["masked"] == pytest.approx(0.25) and facts["made"]["mask"] == str(tmp_path / "mask.png")
    np.testing.assert_array_equal(load_textons(kept).labels[0] >= 0, white > 0)


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["-o", "{here}/a.npz"], "--output a.npz: textons are kept in one file, name it .textons"),
        (["-o", "{here}/no/a.textons"], "there is no folder"),
        (["-o", "{out}", "--features", "colour"], "unknown features 'colour': choose window or filters"),
        (["-o", "{out}", "--window", "4"], "window 4: give an odd number of texels from 3 to 31"),
        (["-o", "{out}", "--orientations", "65"], "65 orientations: give 1 to 64"),
        (["-o", "{out}", "--count", "0"], "--count"),
        (["-o", "{out}", "--map", "{here}/m.gif"], "--map m.gif"),
        (["-o", "{out}", "--report", "{here}/r.pdf"], "--report r.pdf"),
    ],
)
def test_mistakes_are_told_in_one_line(sample: Path, words: list[str], message: str, capsys: Captured) -> None:
    here = sample.parent
    given = [word.replace("{here}", str(here)).replace("{out}", str(here / "a.textons")) for word in words]
    assert run("textons", sample, *given) == 2
    out, err = capsys.readouterr()
    assert not out and err.startswith("texloom: ") and err.count("\n") == 1 and message in err
    assert list(here.iterdir()) == [sample]


@needs_data
@pytest.mark.parametrize("path", sorted(DATA.glob("images-bad/*")), ids=lambda path: path.name)
def test_an_awkward_sample(path: Path, tmp_path: Path, capsys: Captured) -> None:
    out = tmp_path / "a.textons"
    status = run("textons", path, "-o", out, "--orientations", 2)
    told, err = capsys.readouterr()
    if status == 0:
        assert told and not err and load_textons(out).count >= 1
    else:
        assert status == 2 and not told and not list(tmp_path.iterdir())
        assert err.startswith(f"texloom: {path.name}") and err.count("\n") == 1


def test_a_page_tells_of_samples_not_of_textons(sample: Path, tmp_path: Path, capsys: Captured) -> None:
    kept = tmp_path / "a.textons"
    assert run("textons", sample, "-o", kept, "--orientations", 1) == 0
    assert run("inspect", kept, "--report", tmp_path / "r.html") == 2
    assert "--report tells of a sample" in capsys.readouterr().err
