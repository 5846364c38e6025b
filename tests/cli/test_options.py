from pathlib import Path

import pytest

from texloom.cli.options import choose, is_file, only_sample, parse_size
from texloom.errors import ParameterError


@pytest.mark.parametrize(("text", "shape"), [("512", (512, 512)), ("640x480", (480, 640)), ("3×2", (2, 3))])
def test_a_size_is_width_by_height(text: str, shape: tuple[int, int]) -> None:
    assert parse_size(text) == shape


@pytest.mark.parametrize("text", ["", "x", "1x", "1x2x3", "-1", "1.5", "0", "99999", "²"])
def test_other_sizes_are_refused(text: str) -> None:
    with pytest.raises(ParameterError, match="--size"):
        parse_size(text)


def test_choices_are_said_in_words() -> None:
    assert choose("colour", "red", ["red", "green"]) == "red"
    with pytest.raises(ParameterError, match=r"^unknown colour 'blue': choose red, green or grey$"):
        choose("colour", "blue", ["red", "green", "grey"])


def test_one_sample_for_now() -> None:
    assert only_sample([Path("a.png")]) == Path("a.png")
    with pytest.raises(ParameterError, match="2 samples"):
        only_sample([Path("a.png"), Path("b.png")])


def test_a_name_with_a_suffix_is_a_file_unless_it_is_a_folder(tmp_path: Path) -> None:
    (tmp_path / "stack.v2").mkdir()
    assert is_file(tmp_path / "new.png") and is_file(tmp_path / "new.xyz")
    assert not is_file(tmp_path / "new") and not is_file(tmp_path / "stack.v2")
