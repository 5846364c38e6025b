from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from texloom.cli.planes import planar_field, plane
from texloom.errors import TexloomError


def test_without_a_field_it_is_a_plain_grid() -> None:
    grid = plane(6, 4, field=None, tileable=True)
    assert grid.shape == (6, 4) and grid.wrap and grid.field is None


def test_uniform_takes_degrees() -> None:
    direction = planar_field("uniform:90", 4, 4).direction
    np.testing.assert_allclose(direction, np.broadcast_to([-1.0, 0.0], (4, 4, 2)), atol=1e-6)  # up the rows


@pytest.mark.parametrize("name", ["radial", "sine", "ring"])
def test_named_fields_have_the_grids_shape(name: str) -> None:
    grid = plane(6, 5, field=name, tileable=False)
    assert grid.field is not None and grid.field.shape == (6, 5, 2)


def test_vectors_and_images_are_stretched_to_the_grid(tmp_path: Path) -> None:
    np.save(tmp_path / "f.npy", np.tile([1.0, 0.0], (2, 2, 1)))
    np.testing.assert_allclose(planar_field(str(tmp_path / "f.npy"), 5, 6).direction[..., 0], 1.0)
    Image.fromarray(np.full((2, 2, 3), (255, 128, 0), np.uint8)).save(tmp_path / "f.png")
    np.testing.assert_allclose(planar_field(str(tmp_path / "f.png"), 5, 6).direction[..., 1], 1.0, atol=1e-3)


@pytest.mark.parametrize(
    ("wish", "tileable", "message"),
    [
        ("spiral", False, "choose uniform, radial, sine, ring, uniform:DEGREES, or a file"),
        ("uniform:east", False, "give degrees, as in uniform:30"),
        ("uniform:nan", False, "give degrees"),
        ("ring", True, "--tileable and --field ring exclude each other"),
    ],
)
def test_other_fields_are_refused(wish: str, tileable: bool, message: str) -> None:
    with pytest.raises(TexloomError, match=message):
        plane(8, 8, field=wish, tileable=tileable)


def test_a_broken_array_is_named(tmp_path: Path) -> None:
    (tmp_path / "f.npy").write_text("no array")
    with pytest.raises(TexloomError, match="f.npy is not an array"):
        planar_field(str(tmp_path / "f.npy"), 4, 4)
