"""Files appear whole or not at all."""

from contextlib import ExitStack

import pytest

from texloom.errors import FileError
from texloom.output.atomic import atomic


def test_a_file_appears_only_when_the_block_ends_well(tmp_path):
    with atomic(tmp_path / "a.txt") as beside:
        beside.write_text("whole")
        assert not (tmp_path / "a.txt").exists()
        assert beside.suffix == ".txt"
    assert [path.name for path in tmp_path.iterdir()] == ["a.txt"]
    assert (tmp_path / "a.txt").read_text() == "whole"


def test_a_failure_leaves_what_was_there(tmp_path):
    (tmp_path / "a.txt").write_text("before")
    with pytest.raises(RuntimeError), atomic(tmp_path / "a.txt") as beside:
        beside.write_text("half")
        raise RuntimeError
    assert (tmp_path / "a.txt").read_text() == "before"
    assert len(list(tmp_path.iterdir())) == 1


def test_several_files_appear_together_or_not_at_all(tmp_path):
    with pytest.raises(RuntimeError), ExitStack() as files:
        files.enter_context(atomic(tmp_path / "a")).write_text("a")
        files.enter_context(atomic(tmp_path / "b")).write_text("b")
        raise RuntimeError
    assert not list(tmp_path.iterdir())


def test_a_missing_folder_and_a_folder_are_named(tmp_path):
    with pytest.raises(FileError, match="no folder"), atomic(tmp_path / "no" / "a.png"):
        pass
    with pytest.raises(FileError, match="is a folder"), atomic(tmp_path):
        pass
