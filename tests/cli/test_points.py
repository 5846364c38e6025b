"""``texloom points``: a file of points, told how even they are; nothing where something is wrong."""

import json
from pathlib import Path

import numpy as np
import pytest

from tests.meshes import torus
from texloom.cli import main as command
from texloom.cli.points import level_counts
from texloom.errors import ParameterError
from texloom.io.mesh import read_mesh

Captured = pytest.CaptureFixture[str]


@pytest.fixture
def ring(tmp_path: Path) -> Path:
    mesh = torus()
    lines = [f"v {x} {y} {z}" for x, y, z in mesh.vertices]
    lines += [f"f {a + 1} {b + 1} {c + 1}" for a, b, c in mesh.faces]
    (tmp_path / "ring.obj").write_text("\n".join(lines))
    return tmp_path / "ring.obj"


def run(*words: object) -> int:
    return command.main([str(word) for word in words])


def test_a_mesh_becomes_points(ring: Path, capsys: Captured) -> None:
    out = ring.with_name("points.ply")
    assert run("points", ring, "-n", 1600, "--levels", 2, "--seed", 3, "-o", out, "--json") == 0
    facts = json.loads(capsys.readouterr().out)
    assert facts["files"] == [str(out)] and facts["points"] == 1600
    assert [level["points"] for level in facts["levels"]] == [400, 1600]
    for level in facts["levels"]:
        assert 0 < level["variation"] <= 0.1 and 0.5 <= level["closest"] <= 1 and level["spacing"] > 0
    head, _, body = out.read_bytes().partition(b"end_header\n")
    assert b"element vertex 1600" in head and b"property float scale" in head
    record = [(name, "<f4") for name in ("x", "y", "z", "nx", "ny", "nz", "scale")] + [("level", "u1")]
    points = np.frombuffer(body, record, 1600)
    assert (points["level"][:400] == 0).all() and (points["level"][400:] == 1).all()
    np.testing.assert_allclose(points["nx"] ** 2 + points["ny"] ** 2 + points["nz"] ** 2, 1, atol=1e-5)
    mesh = read_mesh(out).mesh
    assert len(mesh.vertices) == 1600 and mesh.agrees and len(mesh.vertices) * 2 == len(mesh.faces)


def test_an_archive_has_their_places(ring: Path) -> None:
    out = ring.with_name("points.npz")
    assert run("points", ring, "-n", 600, "--levels", 2, "-o", out) == 0
    with np.load(out) as points:
        mesh = read_mesh(ring).mesh
        corners = mesh.vertices[mesh.faces[points["face"]]]
        np.testing.assert_allclose(np.einsum("pc,pcx->px", points["barycentric"], corners), points["position"])
        assert points["faces.0"].max() == 149 and points["faces.1"].max() == 599
        assert points["level"].tolist() == [0] * 150 + [1] * 450


def test_spacing_by_a_file(ring: Path, capsys: Captured) -> None:
    scale, out = ring.with_name("scale.npy"), ring.with_name("points.npz")
    np.save(scale, np.where(read_mesh(ring).mesh.vertices[:, 0] > 0, 2.0, 1.0))
    assert run("points", ring, "-n", 1000, "--scale", scale, "-o", out) == 0
    assert "1000 points" in capsys.readouterr().out
    with np.load(out) as points:
        right = (points["position"][:, 0] > 0).mean()
        assert 0.15 < right < 0.3  # a fifth, but for the slope between
        assert points["scale"].min() > 0.999 and points["scale"].max() < 2.001


@pytest.mark.parametrize(
    ("words", "told"),
    [
        (["-o", "points.txt"], "written as .ply or .npz"),
        (["-o", "none/points.ply"], "there is no folder"),
        (["-o", "points.ply", "-n", "2"], "fewest"),
        (["-o", "points.ply", "-n", "4"], "too few for the parts"),
        (["-o", "points.ply", "-n", "100", "--levels", "5"], "fewer levels or more points"),
        (["-o", "points.ply", "--scale", "missing.npy"], "missing.npy"),
    ],
)
def test_what_is_wrong_is_said(ring: Path, words: list[str], told: str, capsys: Captured) -> None:
    words = [str(ring.parent / word) if "." in word else word for word in words]
    assert run("points", ring, *words) == 2
    error = capsys.readouterr().err
    assert told in error and error.count("\n") == 1
    assert not list(ring.parent.glob("points.*"))


def test_levels_are_quarters() -> None:
    assert level_counts(64_000, 3) == (4000, 16_000, 64_000)
    assert level_counts(64_000, 1) == (64_000,)
    with pytest.raises(ParameterError, match="coarsest would have 1"):
        level_counts(100, 4)
