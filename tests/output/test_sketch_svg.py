from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest

from texloom.errors import FileError
from texloom.io.svg import read_svg
from texloom.output.sketch_svg import write_sketch_svg


def some_curves() -> np.ndarray:
    """Curves and, every third, a straight line."""
    curves = np.random.default_rng(0).uniform(-20, 80, (12, 4, 2))
    thirds = np.array([0, 1 / 3, 2 / 3, 1])[:, None]
    curves[::3] = curves[::3, :1] + thirds * (curves[::3, 3:] - curves[::3, :1])
    return curves


def test_curves_come_back_as_they_were(tmp_path: Path) -> None:
    curves = some_curves()
    strokes = read_svg(write_sketch_svg(tmp_path / "a.svg", (50.5, 70), curves))
    assert strokes.size == (50.5, 70) and len(strokes) == len(curves)
    np.testing.assert_allclose(strokes.curves, curves, atol=1e-4)


def test_settings_are_stored_and_lines_are_lines(tmp_path: Path) -> None:
    path = write_sketch_svg(
        tmp_path / "a.svg", (60, 60), some_curves(), settings={"sketch": "a<b & c.svg", "seed": "3"}
    )
    root = ElementTree.parse(path).getroot()
    assert root.findtext("{*}desc") == "sketch: a<b & c.svg; seed: 3"
    kinds = ["C" in element.attrib["d"] for element in root.findall(".//{*}path")]
    assert kinds == [n % 3 > 0 for n in range(12)]


def test_without_a_folder_nothing_is_written(tmp_path: Path) -> None:
    with pytest.raises(FileError, match="there is no folder"):
        write_sketch_svg(tmp_path / "none" / "a.svg", (60, 60), some_curves())
