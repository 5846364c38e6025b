"""What a paper's method learns from a sample is saved, found again, and never taken for another's."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from texloom.cli import main as command
from texloom.demo import draw
from texloom.domain.grid import Grid
from texloom.errors import ExemplarError, ParameterError
from texloom.exemplar.exemplar import Exemplar
from texloom.output.image import write_images
from texloom.search.analysis import Analysis
from texloom.synthesis.boundary import BoundarySampling
from texloom.synthesis.least_squares import LeastSquares, Stage
from texloom.synthesis.synthesize import synthesize

Captured = pytest.CaptureFixture[str]
METHODS = [
    LeastSquares(schedule=(Stage(2, 8), Stage(1, 8)), iterations=2),
    BoundarySampling(patch=16, steps=(2, 1)),
]


@pytest.fixture(scope="module")
def exemplar() -> Exemplar:
    weave = draw("weave", size=48)
    return Exemplar({"basecolor": weave.maps["basecolor"]})


@pytest.fixture
def sample(exemplar: Exemplar, tmp_path: Path) -> Path:
    write_images(tmp_path / "sample.png", exemplar.maps)
    return tmp_path / "sample.png"


@pytest.mark.parametrize("method", METHODS, ids=lambda method: type(method).__name__)
def test_a_known_analysis_gives_the_same_sources(exemplar: Exemplar, method: LeastSquares | BoundarySampling) -> None:
    known = replace(method, analysis=method.analyse(exemplar))
    assert known == method and "analysis" not in repr(known)
    fresh, again = (synthesize(exemplar, Grid(24, 20), m, seed=4).sources for m in (method, known))
    np.testing.assert_array_equal(fresh.position, again.position)


@pytest.mark.parametrize("method", METHODS, ids=lambda method: type(method).__name__)
def test_an_analysis_belongs_to_its_pixels_and_levels(
    exemplar: Exemplar, method: LeastSquares | BoundarySampling
) -> None:
    other = exemplar.crop(slice(0, 40), slice(0, 48))
    with pytest.raises(ExemplarError, match="other pixels"):
        replace(method, analysis=method.analyse(other)).analyse(exemplar)
    coarse = LeastSquares(schedule=(Stage(1, 8),)).analyse(exemplar)
    with pytest.raises(ParameterError, match="has 1 levels of 4 dimensions, but this method needs 2 of 4"):
        replace(method, analysis=coarse).analyse(exemplar)


def test_the_command_learns_once(
    sample: Path, tmp_path: Path, capsys: Captured, monkeypatch: pytest.MonkeyPatch
) -> None:
    kept = tmp_path / "a.npz"
    grow = [
        "image",
        sample,
        "--size",
        16,
        "--preset",
        "resampling",
        "--method",
        "patches",
        "--analysis",
        kept,
        "--json",
    ]
    assert command.main([*map(str, grow), "-o", str(tmp_path / "1.png")]) == 0
    assert str(kept) in json.loads(capsys.readouterr().out)["files"]
    saved = kept.read_bytes()

    def refuse(*_: object, **__: object) -> Analysis:
        raise AssertionError("learnt again")

    monkeypatch.setattr("texloom.synthesis.least_squares.analyse", refuse)
    assert command.main([*map(str, grow), "-o", str(tmp_path / "2.png")]) == 0
    facts = json.loads(capsys.readouterr().out)
    assert str(kept) not in facts["files"] and kept.read_bytes() == saved
    first, second = (np.asarray(Image.open(tmp_path / name)) for name in ("1.png", "2.png"))
    np.testing.assert_array_equal(first, second)

    assert command.main(["inspect", str(kept), "--json"]) == 0
    facts = json.loads(capsys.readouterr().out)
    assert (facts["kind"], facts["sample"], facts["levels"], facts["dimensions"]) == ("analysis", [48, 48], 3, 4)
    assert len(facts["learnt for"]) == 3


@pytest.mark.parametrize(
    ("kept", "words", "message"),
    [
        (b"no archive", ["--preset", "resampling"], "a.npz is not a saved analysis"),
        (None, [], "--analysis a.npz is for a paper's method: add --preset resampling"),
    ],
)
def test_other_files_are_refused(
    sample: Path, tmp_path: Path, capsys: Captured, kept: bytes | None, words: list[str], message: str
) -> None:
    path = tmp_path / "a.npz"
    if kept is not None:
        path.write_bytes(kept)
    grow = ["image", str(sample), "-o", str(tmp_path / "out.png"), "--analysis", str(path), *words]
    assert command.main(grow) == 2
    out, err = capsys.readouterr()
    assert not out and err.count("\n") == 1 and message in err
    assert not (tmp_path / "out.png").exists() and path.exists() == (kept is not None)


@pytest.mark.parametrize(("field", "value", "message"), [("version", 99, "version 99"), ("pixels", 0, "other pixels")])
def test_another_version_and_other_pixels_are_named(
    exemplar: Exemplar, sample: Path, tmp_path: Path, capsys: Captured, field: str, value: int, message: str
) -> None:
    path = tmp_path / "a.npz"
    of = exemplar if field == "version" else exemplar.crop(slice(0, 40), slice(0, 40))
    LeastSquares(schedule=(Stage(1, 8),)).analyse(of).save(path)
    if field == "version":
        arrays = dict(np.load(path))
        header = json.loads(str(arrays.pop("header"))) | {"texloom_analysis": value}
        np.savez(path, allow_pickle=False, **arrays, header=np.array(json.dumps(header)))
    grow = ["image", str(sample), "-o", str(tmp_path / "out.png"), "--preset", "resampling", "--analysis", str(path)]
    assert command.main(grow) == 2
    err = capsys.readouterr().err
    assert err.startswith("texloom: a.npz") and message in err and err.count("\n") == 1
