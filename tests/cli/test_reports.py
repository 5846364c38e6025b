"""``--report``: what it tells is of this very run."""

import shlex
from pathlib import Path

import numpy as np
import pytest

from tests.output.test_report import Page
from texloom.cli import main as command
from texloom.cli.reports import Run, of_image
from texloom.demo import draw
from texloom.demo.polygonise import polygonise
from texloom.demo.shapes import ball
from texloom.demo.write import write_obj
from texloom.domain.grid import Grid
from texloom.exemplar.exemplar import Exemplar
from texloom.output.gather import gather_images, identity_sources
from texloom.output.image import write_images
from texloom.output.report import report_html
from texloom.sources import SourceMap
from texloom.synthesis.result import Result

SETTINGS = {"sample": "weave", "software": "texloom 0", "seed": "0"}


@pytest.fixture(scope="module")
def exemplar() -> Exemplar:
    weave = draw("weave", size=48)
    return Exemplar({name: weave.maps[name] for name in ("basecolor", "normal")})


@pytest.fixture(scope="module")
def folder(exemplar: Exemplar, tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("reports")
    write_images(folder / "a weave", exemplar.maps)
    write_obj(
        folder / "ball.obj", polygonise(ball((0, 0, 0), 1.0), low=np.full(3, -1.3), high=np.full(3, 1.3), step=0.3)
    )
    return folder


def red(picture: np.ndarray) -> int:
    """Pixels in the colour of borders."""
    return int(((picture[..., 0] == 255) & (picture[..., 1] == stored_red) & (picture[..., 2] == 0)).sum())


stored_red = 48  # sRGB byte of the border's linear 0.03


@pytest.mark.parametrize("degrees", [0, 30, 90])
@pytest.mark.parametrize("enlarged", [1.0, 2.0])
def test_one_piece_along_a_field_has_no_border(exemplar: Exemplar, degrees: float, enlarged: float) -> None:
    """A picture that shows one turned, enlarged piece of the sample is nowhere broken; moving half of it breaks it."""
    rows, columns, angle = 20, 24, np.deg2rad(degrees)
    along = np.array([-np.sin(angle), np.cos(angle)])  # [row, column], counter-clockwise
    down = np.array([along[1], -along[0]])
    place = np.stack(np.indices((rows, columns)), -1).reshape(-1, 2) - np.array([10, 12])
    position = 24 + np.stack([place @ down, place @ along], 1) / enlarged
    field, magnitude = np.broadcast_to(along, (rows, columns, 2)), np.full((rows, columns), enlarged)
    grid = Grid(rows, columns, field=field, magnitude=magnitude)
    pictures = []
    for moved in (0.0, 3.0):
        shifted = position + moved * (place[:, :1] > 0)
        sources = SourceMap(shifted[:, None].astype(np.float32), np.ones((rows * columns, 1), np.float32))
        maps = gather_images(sources, exemplar, rows=rows, columns=columns)
        account = of_image(Run(exemplar, Result(sources), SETTINGS, {}, "texloom"), grid, maps)
        pictures.append(account.figures["Origin"][0].picture)
    assert red(pictures[0]) == 0 and red(pictures[1]) == columns


def test_an_image_is_told_in_full(folder: Path) -> None:
    words = ["image", str(folder / "a weave"), "-o", str(folder / "out"), "--size", "40x30", "--seed", "3"]
    words += ["--report", str(folder / "i.html")]
    assert command.main(words) == 0
    page = Page((folder / "i.html").read_text(encoding="utf-8"))
    said = "\n".join(page.text)
    assert shlex.join(["texloom", *words]) in said
    for heading in ("Sample", "Result", "Its other maps", "Origin", "Scores", "Energy", "Seconds", "Do it again"):
        assert heading in page.text
    for name in ("swd", "coherence", "completeness", "copy", "seam", "correction", "40x30"):
        assert name in page.text
    assert len([1 for tag, name, _ in page.attributes if (tag, name) == ("img", "src")]) == 2 + 2 + 2


def test_a_surface_is_told_in_full(folder: Path) -> None:
    words = ["surface", str(folder / "ball.obj"), str(folder / "a weave"), "-o", str(folder / "b.glb")]
    words += ["--repeats", "2", "--report", str(folder / "s.html")]
    assert command.main(words) == 0
    page = Page((folder / "s.html").read_text(encoding="utf-8"))
    assert shlex.join(["texloom", *words]) in "\n".join(page.text)
    for heading in ("Sample", "Result", "Origin", "Scores", "Energy", "Seconds", "completeness", "ball.obj"):
        assert heading in page.text
    assert "copy" not in page.text


def test_without_scores_it_says_why(folder: Path) -> None:
    words = ["image", str(folder / "a weave"), "-o", str(folder / "t"), "--size", "5", "--report"]
    assert command.main([*words, str(folder / "t.html")]) == 0
    assert "No scores: scores need pictures" in (folder / "t.html").read_text(encoding="utf-8")


def test_every_curve_of_a_method_is_plotted(exemplar: Exemplar) -> None:
    sources = identity_sources(*exemplar.shape)
    curves = {"MSE": (3.0, 2.0, 1.0), "changed pixels": (9.0, 4.0, 0.0), "none yet": ()}
    grid = Grid(*exemplar.shape)
    account = of_image(Run(exemplar, Result(sources, curves=curves), SETTINGS, {}, "texloom"), grid, exemplar.maps)
    html = report_html(account)
    assert {"MSE", "changed pixels"} <= set(Page(html).text) and "none yet" not in html
    assert html.count("<polyline") == 2
