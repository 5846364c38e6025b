"""``texloom surface`` given many meshes: each as if alone; what is wrong with one is told and the others go on."""

import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from tests.cli.test_interrupt import PROGRAM
from texloom.cli import main as command
from texloom.cli.session import Session
from texloom.demo import write_sample
from texloom.demo.polygonise import polygonise
from texloom.demo.shapes import ball
from texloom.demo.write import write_obj
from texloom.mesh.gltf import unpack

Captured = pytest.CaptureFixture[str]
BAD = "bad.obj: the mesh has 1 vertices but no faces"


@pytest.fixture(scope="module")
def shelf(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder of balls with one that is none, a list of two of them, and a sample's textons."""
    shelf = tmp_path_factory.mktemp("many")
    (shelf / "meshes").mkdir()
    for name, size in (("a", 1.0), ("b", 0.8), ("c", 0.6)):
        made = polygonise(ball((0, 0, 0), size), low=np.full(3, -1.3), high=np.full(3, 1.3), step=0.3)
        write_obj(shelf / "meshes" / f"{name}.obj", made)
    (shelf / "meshes" / "bad.obj").write_text("v 0 0 0\n")
    (shelf / "meshes" / "notes.md").write_text("no mesh")
    (shelf / "two.txt").write_text("meshes/c.obj\n\nmeshes/a.obj\n")
    write_sample(shelf / "weave", "weave", size=48)
    sample = [str(shelf / "weave" / "basecolor.png"), "-o", str(shelf / "weave.textons")]
    assert command.main(["textons", *sample]) == 0
    return shelf


def run(shelf: Path, mesh: str | Path, out: Path, *words: object) -> int:
    line = ["surface", shelf / mesh, shelf / "weave.textons", "--method", "texton", "--repeats", 1, "-o", out, *words]
    return command.main([str(word) for word in line])


def test_each_is_what_it_is_alone(shelf: Path, tmp_path: Path, capsys: Captured) -> None:
    assert run(shelf, "two.txt", tmp_path / "all", "--json") == 0
    out, err = capsys.readouterr()
    told = json.loads(out)
    assert not err and told["failed"] == [] and [entry["mesh"] for entry in told["meshes"]] == ["c.obj", "a.obj"]
    assert told["files"] == [str(tmp_path / "all" / name) for name in ("c.glb", "a.glb")]
    for name in ("a", "c"):
        assert run(shelf, f"meshes/{name}.obj", tmp_path / f"{name}.glb") == 0
        assert (tmp_path / f"{name}.glb").read_bytes() == (tmp_path / "all" / f"{name}.glb").read_bytes()
    assert told["meshes"][0]["texel"] < told["meshes"][1]["texel"]  # of its own size


def test_a_bad_one_does_not_stop_the_others(shelf: Path, tmp_path: Path, capsys: Captured) -> None:
    assert run(shelf, "meshes", tmp_path / "out") == 2
    out, err = capsys.readouterr()
    assert err.startswith(f"texloom: {BAD}") and err.count("\n") == 1
    assert out == f"3 of 4 meshes textured, in {tmp_path / 'out'}\n"
    assert sorted(file.name for file in (tmp_path / "out").iterdir()) == ["a.glb", "b.glb", "c.glb"]
    assert run(shelf, "meshes", tmp_path / "out", "--json") == 2  # over what is there
    told = json.loads(capsys.readouterr().out)
    assert told["failed"] == ["bad.obj"] and told["meshes"][2]["failed"].startswith(BAD)


def test_listed_and_not_there(shelf: Path, tmp_path: Path, capsys: Captured) -> None:
    (shelf / "some.txt").write_text("meshes/a.obj\nmeshes/gone.obj\nweave/basecolor.png\n")
    assert run(shelf, "some.txt", tmp_path / "out") == 2
    first, second = capsys.readouterr().err.splitlines()
    assert first.startswith("texloom: gone.obj") and second.startswith("texloom: basecolor.png")
    assert [file.name for file in (tmp_path / "out").iterdir()] == ["a.glb"]


def test_where_all_fail_nothing_is_left(shelf: Path, tmp_path: Path, capsys: Captured) -> None:
    (tmp_path / "bad.txt").write_text(str(shelf / "meshes" / "bad.obj"))
    assert run(shelf, tmp_path / "bad.txt", tmp_path / "out") == 2
    assert BAD in capsys.readouterr().err and not (tmp_path / "out").exists()


@pytest.mark.parametrize("home", ["atlas", "vertex"])
def test_ways_home(shelf: Path, tmp_path: Path, home: str, capsys: Captured) -> None:
    assert run(shelf, "two.txt", tmp_path / "out", "--as", home, "--atlas-size", 64) == 0
    for name in ("a", "c"):
        primitive = unpack((tmp_path / "out" / f"{name}.glb").read_bytes()).json["meshes"][0]["primitives"][0]
        assert ("COLOR_0" in primitive["attributes"]) == (home == "vertex")


def test_other_methods_take_many_too(shelf: Path, tmp_path: Path, capsys: Captured) -> None:
    line = ["surface", shelf / "two.txt", shelf / "weave", "--repeats", 1, "-o", tmp_path / "out", "--atlas-size", 64]
    assert command.main([str(word) for word in line]) == 0
    assert sorted(file.name for file in (tmp_path / "out").iterdir()) == ["a.glb", "c.glb"]


@pytest.mark.parametrize("option", ["preview", "edges", "report", "sources"])
def test_files_about_one_mesh_are_refused(shelf: Path, tmp_path: Path, option: str, capsys: Captured) -> None:
    assert run(shelf, "two.txt", tmp_path / "out", f"--{option}", tmp_path / "x.png") == 2
    told_once("x.png is about one mesh, but 2 were given: leave it out", capsys)
    assert not list(tmp_path.iterdir())


def test_outputs_that_do_not_fit(shelf: Path, tmp_path: Path, capsys: Captured) -> None:
    assert run(shelf, "two.txt", tmp_path / "a.glb") == 2
    told_once("a.glb: 2 meshes go into a folder: give one", capsys)
    (tmp_path / "file").write_text("")
    assert run(shelf, "two.txt", tmp_path / "file") == 2
    told_once("file: 2 meshes go into a folder: give one", capsys)
    assert run(shelf, "two.txt", tmp_path / "no" / "out") == 2
    told_once("there is no folder", capsys)
    assert [file.name for file in tmp_path.iterdir()] == ["file"]


def test_inputs_that_do_not_fit(shelf: Path, tmp_path: Path, capsys: Captured) -> None:
    """None, two that would go into one file, and one that its own result would overwrite."""
    meshes = tmp_path / "meshes"
    meshes.mkdir()
    assert run(shelf, meshes, tmp_path / "out") == 2
    told_once("no meshes there", capsys)
    assert run(shelf, shelf / "none.txt", tmp_path / "out") == 2
    told_once("none.txt cannot be read", capsys)
    assert run(shelf, "meshes/a.obj", meshes / "a.glb") == 0
    before = (meshes / "a.glb").read_bytes()
    capsys.readouterr()
    assert run(shelf, meshes, meshes) == 2
    told_once("a.glb would be overwritten by its own result: give another folder", capsys)
    assert (meshes / "a.glb").read_bytes() == before
    (meshes / "a.obj").write_bytes((shelf / "meshes" / "a.obj").read_bytes())
    assert run(shelf, meshes, tmp_path / "out") == 2
    told_once("two meshes are called a, one would overwrite the other: rename one", capsys)
    assert not (tmp_path / "out").exists()


def test_an_interrupt_from_outside(shelf: Path, tmp_path: Path) -> None:
    words = ["surface", shelf / "two.txt", shelf / "weave.textons", "--method", "texton", "-o", tmp_path / "out"]
    program = [sys.executable, "-c", PROGRAM, "3", *map(str, words)]
    done = subprocess.run(program, capture_output=True, text=True)
    assert done.returncode == 130 and done.stdout == "" and not list(tmp_path.iterdir())
    assert done.stderr == "texloom: interrupted, nothing written\n"


@pytest.mark.parametrize(("stage", "time"), [("c.obj", 1), ("write", 2)])
@pytest.mark.parametrize("threads", [1, 2])
def test_an_interrupt_leaves_whole_meshes(
    shelf: Path, tmp_path: Path, stage: str, time: int, threads: int, monkeypatch: pytest.MonkeyPatch, capsys: Captured
) -> None:
    """Between two meshes, and when the second is about to be written."""
    seen: list[str] = []

    def report(self: Session, name: str, done: float) -> None:
        seen.append(name)
        if name == stage and seen.count(name) == time:
            raise KeyboardInterrupt

    monkeypatch.setattr(Session, "report", report)
    assert run(shelf, "two.txt", tmp_path / "out", "--threads", threads) == 130
    assert capsys.readouterr().err == f"texloom: interrupted, after writing {tmp_path / 'out' / 'c.glb'}\n"
    assert [file.name for file in (tmp_path / "out").iterdir()] == ["c.glb"]


def told_once(message: str, capsys: Captured) -> None:
    """One line on stderr says so."""
    out, err = capsys.readouterr()
    assert out == "" and err.startswith("texloom: ") and err.count("\n") == 1 and message in err
