"""Every awkward file ends well or in one clear line that begins with its name."""

from pathlib import Path

import pytest

from tests.data import DATA, needs_data
from texloom.cli import main as command

AWKWARD = sorted(DATA.glob("images-bad/*")) + sorted(DATA.glob("meshes-bad/*"))


@needs_data
@pytest.mark.parametrize("path", AWKWARD, ids=lambda path: path.name)
def test_an_awkward_file(path: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    output = tmp_path / "out.png"
    grow = ["image", str(path), "-o", str(output), "--size", "16"]
    status = command.main(grow if path.parent.name == "images-bad" else ["inspect", str(path)])
    out, err = capsys.readouterr()
    if status == 0:
        assert out and not err
    else:
        assert status == 2 and not out and not output.exists()
        assert err.startswith(f"texloom: {path.name}") and err.count("\n") == 1
