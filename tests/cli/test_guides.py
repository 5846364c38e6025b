import json
from pathlib import Path

import numpy as np
import pytest

from texloom.cli.fields import direction_field, guide_file, scale_field
from texloom.cli.guides import placed_arrows, vertex_rows
from texloom.errors import FieldError, TexloomError
from texloom.field.direction import vertex_directions
from texloom.mesh.mesh import Mesh
from texloom.mesh.model import Model


@pytest.fixture
def model() -> Model:
    """Two triangles whose file has its vertices in another order: mesh vertex i is file vertex 4 - i; 0 is unused."""
    mesh = Mesh(np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]), np.array([[0, 1, 2], [0, 2, 3]], np.int32))
    return Model(Path("square.obj"), mesh, None, (4 - mesh.faces).astype(np.int32), np.arange(2, dtype=np.int32), ())


def written(folder: Path, arrows: object) -> Path:
    path = folder / "arrows.json"
    path.write_text(json.dumps(arrows))
    return path


def test_arrows_stand_at_vertices_counted_as_in_the_file(tmp_path: Path, model: Model) -> None:
    arrows = [{"vertex": 3, "direction": [0, 1, 0]}, {"point": [0.1, 0.9, 5], "scale": 0.5}]
    placed = placed_arrows(written(tmp_path, arrows), model)
    np.testing.assert_array_equal(placed.direction_vertex, [1])
    np.testing.assert_array_equal(placed.scale_vertex, [3])
    np.testing.assert_array_equal(placed.scale, [0.5])


@pytest.mark.parametrize("suffix", [".npy", ".txt", ".csv"])
def test_rows_are_those_of_the_files_vertices(tmp_path: Path, model: Model, suffix: str) -> None:
    path = tmp_path / f"scale{suffix}"
    values = np.array([9.0, 1, 2, 3, 4])
    if suffix == ".npy":
        np.save(path, values)
    else:
        path.write_text("\n".join(f"{value}" for value in values))
    np.testing.assert_array_equal(vertex_rows(path, model, columns=1), [[4], [3], [2], [1]])


@pytest.mark.parametrize("prefix", ["", "rbf:", "spread:"])
def test_a_field_goes_through_the_arrows_of_a_file(tmp_path: Path, model: Model, prefix: str) -> None:
    path = written(tmp_path, [{"vertex": 3, "direction": [3, 3, 9], "scale": 2.0}])
    field = direction_field(model, f"{prefix}{path}", order=1)
    diagonal = np.array([np.sqrt(0.5), np.sqrt(0.5), 0.0])
    np.testing.assert_allclose(vertex_directions(model.mesh, field), np.tile(diagonal, (4, 1)), atol=1e-6)
    scale = scale_field(model, None, f"{prefix}{path}")
    assert scale is not None
    np.testing.assert_allclose(scale, 2.0)


def test_rows_of_vectors_are_the_field(tmp_path: Path, model: Model) -> None:
    np.save(tmp_path / "v.npy", np.tile([0.0, 2.0, 1.0], (5, 1)))
    field = direction_field(model, str(tmp_path / "v.npy"), order=1)
    np.testing.assert_allclose(vertex_directions(model.mesh, field), np.tile([0.0, 1.0, 0.0], (4, 1)), atol=1e-6)


def test_a_wish_is_a_name_a_vector_or_a_file() -> None:
    assert guide_file("smooth") is guide_file("curvature") is guide_file("0,-1,0.5") is None
    assert guide_file("a.json") == guide_file("rbf:a.json") == guide_file("spread:a.json") == Path("a.json")


@pytest.mark.parametrize(
    ("arrows", "message"),
    [
        ([{"vertex": 1, "direction": [0, 1, 0]}, {"vertex": 1}], "arrow 1.*asks for"),
        ([{"vertex": 9, "direction": [0, 1, 0]}], "arrow 0 stands at vertex 9, but no face has it; the last is 4"),
        ([{"vertex": 0, "direction": [0, 1, 0]}], "arrow 0 stands at vertex 0, but no face has it"),
        ([{"vertex": 1, "direction": [0, 0, 1]}], "along the normal"),
        ([{"vertex": 1, "scale": 2}], "none of its 1 arrows gives a direction"),
    ],
)
def test_bad_arrows_are_named(tmp_path: Path, model: Model, arrows: object, message: str) -> None:
    with pytest.raises(TexloomError, match=f"^arrows.json.*{message}"):
        direction_field(model, str(written(tmp_path, arrows)), order=1)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("1\n2", "2 rows, but faces use vertices up to 4"),
        ("1 2\n" * 5, "2 numbers a row: give 1"),
        ("1\n-1\n1\n1\n1", "above 0"),
    ],
)
def test_bad_rows_are_named(tmp_path: Path, model: Model, text: str, message: str) -> None:
    path = tmp_path / "scale.txt"
    path.write_text(text)
    with pytest.raises(FieldError, match=message):
        scale_field(model, path, "smooth")
