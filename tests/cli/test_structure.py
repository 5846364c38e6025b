"""``texloom inspect`` of a sample: the same numbers in words, as JSON and on a page."""

import json
from pathlib import Path

import numpy as np
import pytest

from tests.output.test_report import Page
from texloom.cli import main as command
from texloom.cli.structure import autocorrelation_picture
from texloom.demo import draw
from texloom.exemplar.regularity import Regularity
from texloom.output.image import write_images


@pytest.fixture
def sample(tmp_path: Path) -> Path:
    write_images(tmp_path / "weave.png", {"basecolor": draw("weave", size=96).maps["basecolor"]})
    return tmp_path / "weave.png"


def test_a_sample_is_told_in_numbers_and_on_a_page(sample: Path, capsys: pytest.CaptureFixture[str]) -> None:
    page = sample.parent / "r.html"
    assert command.main(["inspect", str(sample), "--report", str(page), "--json"]) == 0
    facts = json.loads(capsys.readouterr().out)
    assert facts["files"] == [str(page)]
    assert facts["suggested"]["window"] == round(2 * facts["dominant scale"])
    spectrum = facts["spectrum"]
    assert len(spectrum["frequency"]) == len(spectrum["power"]) and sum(spectrum["power"]) == pytest.approx(1, abs=1e-2)
    assert min(abs(1 / f - facts["dominant scale"]) for f in spectrum["frequency"]) < 0.01
    told = Page(page.read_text(encoding="utf-8"))
    for said in ("Spectrum", "Autocorrelation", f"dominant scale {facts['dominant scale']:.1f}"):
        assert said in told.text
    assert command.main(["inspect", str(sample)]) == 0
    words = capsys.readouterr().out
    assert "suggested method" in words and "regularity" in words and "spectrum" not in words


def test_a_page_is_of_samples_only(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "a.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    assert command.main(["inspect", str(tmp_path / "a.obj"), "--report", str(tmp_path / "r.html")]) == 2
    assert "--report tells of a sample" in capsys.readouterr().err
    assert not (tmp_path / "r.html").exists()


def test_lattice_points_are_dots_on_the_peaks() -> None:
    flat = np.zeros((41, 41), np.float32)
    picture = autocorrelation_picture(Regularity(0.5, ((10.0, 0.0), (0.0, 10.0)), flat))
    dots = (picture == (235, 60, 30)).all(axis=2)
    enlarged = len(picture) // 41
    for row in (0, 10, 20, 30, 40):
        assert all(dots[int((row + 0.5) * enlarged), int((column + 0.5) * enlarged)] for column in (0, 10, 20, 30, 40))
    assert dots.mean() < 0.05
    assert not (autocorrelation_picture(Regularity(0.01, ((10.0, 0.0),), flat)) == (235, 60, 30)).all(axis=2).any()
