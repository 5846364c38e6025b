from pathlib import Path

import numpy as np

from texloom.demo.samples import draw
from texloom.demo.write import write_obj, write_sample
from texloom.io.image import read_image
from texloom.mesh.mesh import Mesh


def test_a_sample_reads_back_as_it_was_drawn(tmp_path: Path) -> None:
    files = write_sample(tmp_path / "weave", "weave", size=32)
    assert sorted(file.name for file in files) == [
        "ao.png", "basecolor.png", "height.png", "metallic.png", "normal.png", "roughness.png",
    ]  # fmt: skip
    height = read_image(tmp_path / "weave" / "height.png", kind="data")
    assert height.bits == 16
    np.testing.assert_allclose(height.image, draw("weave", size=32).maps["height"].image, atol=1e-5)


def test_obj_counts_from_one(tmp_path: Path) -> None:
    triangle = Mesh(np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0]]), np.array([[0, 1, 2]], np.int32))
    lines = write_obj(tmp_path / "t.obj", triangle).read_text().splitlines()
    assert lines[1] == "v 1.000000 0.000000 0.000000" and lines[-1] == "f 1 2 3"
