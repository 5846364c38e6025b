import json
from pathlib import Path

import numpy as np
import pytest

from texloom.cli.guides import read_guides
from texloom.errors import FieldError, FileError, TexloomError
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


def test_arrows_stand_at_vertices_of_the_file_or_at_the_nearest_point(tmp_path: Path, model: Model) -> None:
    path = written(
        tmp_path,
        [{"vertex": 3, "direction": [0, 1, 0]}, {"point": [0.1, 0.9, 5], "direction": [2, 0, 0], "scale": 0.5}],
    )
    guides = read_guides(path, model, wanted="direction")
    vertex, direction = guides.directed()
    np.testing.assert_array_equal(vertex, [1, 3])
    np.testing.assert_array_equal(direction, [[0, 1, 0], [2, 0, 0]])
    vertex, scale = guides.scaled()
    np.testing.assert_array_equal(vertex, [3])
    np.testing.assert_array_equal(scale, [0.5])


@pytest.mark.parametrize("suffix", [".npy", ".txt", ".csv"])
def test_an_array_has_one_row_a_vertex_of_the_file(tmp_path: Path, model: Model, suffix: str) -> None:
    path = tmp_path / f"scale{suffix}"
    values = np.array([9.0, 1, 2, 3, 4])
    if suffix == ".npy":
        np.save(path, values)
    else:
        path.write_text("\n".join(f"{value}" for value in values))
    vertex, scale = read_guides(path, model, wanted="scale").scaled()
    np.testing.assert_array_equal(scale[np.argsort(vertex)], [4, 3, 2, 1])


@pytest.mark.parametrize(
    ("arrows", "message"),
    [
        ({}, "give a list of arrows"),
        ([], "give a list of arrows"),
        ([3], 'arrow 0 .*: give "point" or "vertex"'),
        ([{"vertex": 1, "direction": [0, 1, 0]}, {"vertex": 1}], "arrow 1 .*: it has neither"),
        ([{"vertex": 1, "point": [0, 0, 0], "scale": 1}], 'give "point" or "vertex"'),
        ([{"vertex": 9, "direction": [0, 1, 0]}], "no face has vertex 9; the last is 4"),
        ([{"vertex": 0, "direction": [0, 1, 0]}], "no face has vertex 0"),
        ([{"vertex": 1, "direction": [0, 1]}], '"direction" is .*give 3 finite numbers'),
        ([{"vertex": 1, "direction": [0, 1, "up"]}], "give 3 finite numbers"),
        ([{"vertex": 1, "scale": -2}], "above 0, one is -2"),
        ([{"vertex": 1, "scale": 2}], "none of its 1 arrows gives a direction"),
    ],
)
def test_bad_arrows_are_named(tmp_path: Path, model: Model, arrows: object, message: str) -> None:
    with pytest.raises(TexloomError, match=message):
        read_guides(written(tmp_path, arrows), model, wanted="direction")


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("1\n2", "2 rows for a mesh of 5"),
        ("1 2\n" * 5, "has 1 column, this one has 2"),
        ("1\nnan\n1\n1\n1", "row 1 .* not finite"),
    ],
)
def test_bad_arrays_are_named(tmp_path: Path, model: Model, text: str, message: str) -> None:
    path = tmp_path / "scale.txt"
    path.write_text(text)
    with pytest.raises(FieldError, match=message):
        read_guides(path, model, wanted="scale")


@pytest.mark.parametrize("name", ["missing.json", "missing.npy", "broken.json", "broken.npy", "broken.txt"])
def test_files_that_cannot_be_read_are_named(tmp_path: Path, model: Model, name: str) -> None:
    if name.startswith("broken"):
        (tmp_path / name).write_text("[1, 2")
    with pytest.raises(FileError, match=name):
        read_guides(tmp_path / name, model, wanted="scale")
