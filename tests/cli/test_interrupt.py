"""Ctrl-C, whenever it comes: status 130, one line, and only whole files."""

import os
import signal
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from texloom.cli import main as command
from texloom.demo import write_sample

# Runs a command whose n-th report of progress is answered with a Ctrl-C from outside.
PROGRAM = """
import os, signal, sys
from texloom.cli import session
from texloom.cli.main import main

left = int(sys.argv[1])

def report(self, stage, done):
    global left
    left -= 1
    if left == 0:
        os.kill(os.getpid(), signal.SIGINT)

session.Session.report = report
sys.exit(main(sys.argv[2:]))
"""

# Says on stderr that it is at work.
STARTED = """
import sys
from texloom.cli import session
from texloom.cli.main import main

session.Session.report = lambda self, stage, done: print(stage, file=sys.stderr, flush=True)
sys.exit(main(sys.argv[1:]))
"""


@pytest.fixture(scope="module")
def sample(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("sample") / "weave"
    write_sample(folder, "weave", size=48)
    return folder


@pytest.mark.parametrize("after", [1, 7])
def test_an_interrupted_image_leaves_no_part(sample: Path, tmp_path: Path, after: int) -> None:
    words = ["image", sample, "-o", tmp_path / "out", "--size", 300, "--sources", tmp_path / "s.npz"]
    program = [sys.executable, "-c", PROGRAM, str(after), *map(str, words), "--report", str(tmp_path / "r.html")]
    run = subprocess.run(program, capture_output=True, text=True)
    assert run.returncode == 130 and run.stdout == ""
    assert run.stderr.splitlines()[-1].startswith("texloom: interrupted, ") and "Traceback" not in run.stderr
    left = [path for path in tmp_path.rglob("*") if path.is_file()]
    assert not [path for path in left if ".part" in path.name]
    assert len(left) in (0, 6, 7)  # nothing, all maps, or these and the sources


def test_a_command_is_interrupted_from_outside(sample: Path, tmp_path: Path) -> None:
    """At once, while libraries are still being imported."""
    words = ["image", sample, "-o", tmp_path / "out", "--size", 8192, "--json"]
    program = [sys.executable, "-c", STARTED, *map(str, words)]
    process = subprocess.Popen(program, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    assert process.stderr is not None and process.stderr.readline() == "read\n"
    os.kill(process.pid, signal.SIGINT)
    out, err = process.communicate(timeout=60)
    assert process.returncode == 130 and out == ""
    assert err.splitlines()[-1] == "texloom: interrupted, nothing written"
    assert not list(tmp_path.iterdir())


def test_writing_a_folder_interrupted_half_way(
    sample: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    from texloom.output import image

    written: list[int] = []

    def png_bytes(*_: object, **__: object) -> bytes:
        if len(written) == 3:
            raise KeyboardInterrupt
        written.append(1)
        return b"png"

    monkeypatch.setattr(image, "png_bytes", png_bytes)
    assert command.main(["image", str(sample), "-o", str(tmp_path / "out"), "--size", "16"]) == 130
    assert capsys.readouterr().err == "texloom: interrupted, nothing written\n"
    assert not list(tmp_path.iterdir())


def test_a_demo_says_what_it_leaves(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    from texloom import demo

    def write(folder: Path, name: str, **_: object) -> None:
        if name == "pebbles":
            raise KeyboardInterrupt
        folder.mkdir(parents=True)
        Image.fromarray(np.zeros((8, 8), np.uint8)).save(folder / "basecolor.png")

    monkeypatch.setattr(demo, "write_sample", write)
    assert command.main(["demo", "-o", str(tmp_path / "d")]) == 130
    samples = tmp_path / "d" / "samples"
    assert capsys.readouterr().err == f"texloom: interrupted, after writing {samples / 'bricks'}, {samples / 'knit'}\n"
