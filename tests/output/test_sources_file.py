"""Sources kept in a file come back whole; others are refused by name."""

import json

import numpy as np
import pytest

from texloom.errors import FileError
from texloom.output.gather import identity_sources
from texloom.output.sources_file import SavedSources, load_sources, save_sources
from texloom.sources import SourceMap


def test_write_then_read_is_identity(tmp_path):
    sources = identity_sources(5, 6)
    sources = SourceMap(sources.position, sources.weight, turn=np.full((30, 1), 0.25, np.float32))
    domain = {"rows": np.array(5), "columns": np.array(6)}
    saved = SavedSources(sources, domain, {"seed": "3"})
    found = load_sources(save_sources(tmp_path / "a.npz", saved))
    np.testing.assert_array_equal(found.sources.position, sources.position)
    np.testing.assert_array_equal(found.sources.turn, sources.turn)
    assert found.sources.scale is None
    assert found.settings == {"seed": "3"} and int(found.domain["columns"]) == 6
    again = save_sources(tmp_path / "b.npz", saved)
    assert again.read_bytes() == (tmp_path / "a.npz").read_bytes()


@pytest.mark.parametrize("content", [b"", b"no archive", b"PK\x03\x04 broken"])
def test_damage_is_refused(tmp_path, content):
    (tmp_path / "a.npz").write_bytes(content)
    with pytest.raises(FileError, match="a.npz"):
        load_sources(tmp_path / "a.npz")


def test_another_format_is_refused_by_name(tmp_path):
    header = json.dumps({"kind": "texloom-sources", "format": 99, "settings": {}})
    np.savez(tmp_path / "a.npz", header=header)
    with pytest.raises(FileError, match="format 99"):
        load_sources(tmp_path / "a.npz")
    np.savez(tmp_path / "b.npz", other=1)
    with pytest.raises(FileError, match="not a file of sources"):
        load_sources(tmp_path / "b.npz")
