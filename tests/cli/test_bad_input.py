"""Every awkward file ends well, or in one clear line that begins with its name and leaves nothing behind."""

from pathlib import Path

import pytest

from tests.data import DATA, needs_data
from texloom.cli import main as command
from texloom.demo import write_sample

AWKWARD = sorted(DATA.glob("images-bad/*")) + sorted(DATA.glob("meshes-bad/*"))


@pytest.fixture(scope="module")
def sample(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("sample") / "weave"
    write_sample(folder, "weave", size=32)
    return folder / "basecolor.png"


@needs_data
@pytest.mark.parametrize("path", AWKWARD, ids=lambda path: path.name)
def test_an_awkward_file(path: Path, sample: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    mesh = path.parent.name == "meshes-bad"
    words = ["surface", path, sample, "--repeats", 1] if mesh else ["image", path, "--size", 16]
    status = command.main([*map(str, words), "-o", str(tmp_path / ("out.ply" if mesh else "out.png"))])
    out, err = capsys.readouterr()
    err = err.replace("texloom: compiling kernels (once)\n", "")
    if status == 0:
        assert out and not err
    else:
        assert status == 2 and not out and not list(tmp_path.iterdir())
        assert err.startswith(f"texloom: {path.name}") and err.count("\n") == 1
