"""Arrow files are read as written, and their faults named."""

import json

import numpy as np
import pytest

from texloom.errors import FieldError, FileError
from texloom.field.arrows import Arrow
from texloom.io.arrows import read_arrows, read_rows


def test_arrows_are_read(tmp_path):
    path = tmp_path / "arrows.json"
    path.write_text(json.dumps([{"point": [0, 1, 2], "direction": [1, 0, 0]}, {"vertex": 7, "scale": 2}]))
    assert read_arrows(path) == (Arrow(point=(0, 1, 2), direction=(1, 0, 0)), Arrow(vertex=7, scale=2.0))


@pytest.mark.parametrize(
    ("text", "error", "message"),
    [
        ("nonsense", FileError, "is not JSON"),
        ("{}", FileError, "no list"),
        ("[]", FileError, "no list"),
        ("[3]", FieldError, "arrow 0 is no object"),
        ('[{"vertex": 0, "scale": 1}, {"vertex": 1.5, "scale": 1}]', FieldError, "arrow 1: vertex 1.5"),
        ('[{"vertex": true, "scale": 1}]', FieldError, "vertex True"),
        ('[{"vertex": 0, "scale": "big"}]', FieldError, "scale 'big'"),
        ('[{"vertex": 0, "size": 1}]', FieldError, 'has "size"'),
        ('[{"point": [0, 1], "scale": 1}]', FieldError, "point"),
        ('[{"vertex": 0, "direction": [0, 0, 0]}]', FieldError, "no direction"),
        ('[{"vertex": 0, "direction": [0, NaN, 0]}]', FieldError, "no direction"),
        ('[{"direction": [0, 0, 1]}]', FieldError, "give one of the two"),
    ],
)
def test_wrong_arrows_are_named(tmp_path, text, error, message):
    path = tmp_path / "arrows.json"
    path.write_text(text)
    with pytest.raises(error, match=message):
        read_arrows(path)


def test_rows_come_from_text_and_npy(tmp_path):
    rows = np.array([[1.0, 2.5, -3], [0, 0, 1e-3]])
    (tmp_path / "a.txt").write_text("# directions\n1, 2.5, -3\n\n0 0 1e-3  # the last\n")
    np.save(tmp_path / "a.npy", rows)
    np.testing.assert_array_equal(read_rows(tmp_path / "a.txt"), rows)
    np.testing.assert_array_equal(read_rows(tmp_path / "a.npy"), rows)
    (tmp_path / "s.txt").write_text("1\n2\n3\n")
    np.testing.assert_array_equal(read_rows(tmp_path / "s.txt"), [[1], [2], [3]])


@pytest.mark.parametrize(
    ("text", "message"),
    [("", "shape"), ("1 2\n3", "no array"), ("one", "no array"), ("1\nnan\ninf", "2 of 3 rows .* row 1")],
)
def test_wrong_rows_are_named(tmp_path, text, message):
    path = tmp_path / "rows.txt"
    path.write_text(text)
    with pytest.raises(FileError, match=message):
        read_rows(path)


def test_a_missing_file_is_named(tmp_path):
    for read, name in ((read_arrows, "no.json"), (read_rows, "no.npy"), (read_rows, "no.txt")):
        with pytest.raises(FileError, match=f"{name} cannot be read"):
            read(tmp_path / name)
