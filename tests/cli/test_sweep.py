"""``texloom surface --method sweep`` and ``--preset sweep``: every way home, and one line for what does not go."""

import json
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from texloom.cli import main as command
from texloom.demo import write_sample
from texloom.demo.polygonise import polygonise
from texloom.demo.shapes import ball
from texloom.demo.write import write_obj
from texloom.io.mesh import read_mesh
from texloom.mesh.gltf import unpack
from texloom.output.sources_file import load_sources

Captured = pytest.CaptureFixture[str]


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A small ball, and two small stacks of maps."""
    folder = tmp_path_factory.mktemp("sweep")
    for name in ("weave", "scales"):
        write_sample(folder / name, name, size=48)
    faces = polygonise(ball((0, 0, 0), 1.0), low=np.full(3, -1.3), high=np.full(3, 1.3), step=0.3)
    write_obj(folder / "ball.obj", faces)
    corners, triangles = read_mesh(folder / "ball.obj").mesh.vertices, read_mesh(folder / "ball.obj").mesh.faces
    head = f"ply\nformat ascii 1.0\nelement vertex {len(corners)}\n"
    head += "".join(f"property float {name}\n" for name in "xyz")
    head += "".join(f"property uchar {name}\n" for name in ("red", "green", "blue"))
    head += f"element face {len(triangles)}\nproperty list uchar int vertex_indices\nend_header\n"
    body = [f"{x} {y} {z} {'255 0 0' if y > 0 else '0 0 255'}" for x, y, z in corners]
    body += [f"3 {a} {b} {c}" for a, b, c in triangles]
    (folder / "two.ply").write_text(head + "\n".join(body) + "\n")
    return folder


def run(folder: Path, words: str, capsys: Captured) -> dict:
    """A sweep over the ball; % in the words is the folder."""
    line = f"surface %/ball.obj %/weave {words} --json".replace("%", str(folder))
    assert command.main(line.split()) == 0, capsys.readouterr().err
    return json.loads(capsys.readouterr().out)


def sources_after(folder: Path, words: str, capsys: Captured) -> tuple[np.ndarray, str]:
    """Positions of the sources, and the method they tell."""
    run(folder, words, capsys)
    saved = load_sources(folder / "b.npz")
    return saved.sources.position, saved.settings["method"]


def refused(folder: Path, words: str, capsys: Captured) -> str:
    """The one line on stderr."""
    assert command.main(words.replace("%", str(folder)).split()) == 2
    out, err = capsys.readouterr()
    assert not out and err.startswith("texloom: ") and err.count("\n") == 1
    return err


def test_a_stack_comes_home_as_an_atlas_and_can_be_put_on_again(folder: Path, capsys: Captured) -> None:
    words = "--method sweep --texel 0.09 -o %/a.glb --atlas-size 128 --sources %/a.npz --preview %/a.png"
    facts = run(folder, words, capsys)
    maps = {path.stem for path in (folder / "weave").iterdir()}
    assert facts["method"] == "sweep" and set(facts["maps"]) == maps and len(maps) >= 4
    assert facts["stopped"] == "passes"
    assert len(facts["energy"]) == 4 and facts["energy"][-1] < facts["energy"][0]  # two levels, two sweeps each
    assert {"points", "stencils", "sweeps"} <= set(facts["seconds"])
    document = unpack((folder / "a.glb").read_bytes())
    assert "Sweep(" in document.json["asset"]["extras"]["texloom"]["method"]
    material = document.json["materials"][0]
    assert {"normalTexture", "pbrMetallicRoughness"} <= set(material)
    with Image.open(folder / "a.png") as picture:
        assert np.asarray(picture.convert("L")).std() > 10

    words = f"apply {folder}/a.npz {folder}/scales -o {folder}/again"
    assert command.main(words.split()) == 0, capsys.readouterr().err
    capsys.readouterr()
    assert {path.stem for path in (folder / "again").iterdir()} == {path.stem for path in (folder / "scales").iterdir()}


def test_every_option_changes_the_method(folder: Path, capsys: Captured) -> None:
    words = "--method sweep --texel 0.09 -o %/b.ply --sources %/b.npz"
    made = sources_after(folder, words, capsys)
    for option in ("--levels 1", "--start random", "--order sequential", "--search tree", "--window 5", "--passes 1"):
        other = sources_after(folder, f"{words} {option}", capsys)
        name, value = option.removeprefix("--").split()
        assert f"{name}={value}" in other[1] or f"{name}='{value}'" in other[1]
        assert not np.array_equal(made[0], other[0]), option
    half, causal = (
        sources_after(folder, f"{words} --start random --shape {shape}", capsys)[0] for shape in ("half", "causal")
    )
    assert not np.array_equal(half, causal)
    again = sources_after(folder, f"{words} --threads 1", capsys)
    np.testing.assert_array_equal(made[0], again[0])


def test_the_talk_by_name(folder: Path, capsys: Captured) -> None:
    facts = run(folder, "--preset sweep --texel 0.09 -o %/c.ply --levels 2", capsys)
    assert facts["preset"] == "sweep" and facts["method"] == "sweep" and len(facts["energy"]) == 2
    shaped = run(folder, "--preset sweep --texel 0.09 -o %/d.ply --levels 2 --shape full", capsys)
    assert facts["energy"] != shaped["energy"]


def test_crosses_and_two_samples_as_one(folder: Path, capsys: Captured) -> None:
    words = "%/scales --method sweep --texel 0.09 -o %/e.glb --as vertex --symmetry 4 --sources %/e.npz"
    facts = run(folder, words, capsys)
    saved = load_sources(folder / "e.npz")
    assert facts["sites"] == saved.sources.count
    assert saved.sources.turn is not None and len(np.unique(np.rint(saved.sources.turn / (np.pi / 2)))) > 1
    second = saved.domain["parts"][1]  # to the right of the first
    assert 0.02 < (saved.sources.position[:, 0, 1] >= second[1] - 1).mean() < 0.98


def test_it_scores(folder: Path, capsys: Captured) -> None:
    run(folder, "--method sweep --texel 0.042 --passes 1 -o %/f.glb --as vertex", capsys)
    assert command.main(["score", str(folder / "weave"), str(folder / "f.glb"), "--json"]) == 0
    scores = json.loads(capsys.readouterr().out)["scores"]["basecolor"]
    assert set(scores) == {"swd", "coherence", "completeness", "copy"} and 3 < scores["copy"] < 48


@pytest.mark.parametrize(
    ("words", "message"),
    [
        ("image %/weave -o %/x.png --method sweep", "unknown method 'sweep': choose optimize"),
        ("surface %/ball.obj %/weave -o %/x.glb --levels 2", "--levels 2 is not for optimize: add --method sweep"),
        (
            "surface %/ball.obj %/weave -o %/x.glb --method patches --order parallel",
            "--order parallel is not for patches",
        ),
        ("surface %/ball.obj %/weave -o %/x.glb --method sweep --window 6", "window 6 must be odd and 3 or more"),
        ("surface %/ball.obj %/weave -o %/x.glb --method sweep --window 1", "window 1 must be odd"),
        ("surface %/ball.obj %/weave -o %/x.glb --method sweep --window 49", "holds no whole neighbourhood of 49: use"),
        ("surface %/ball.obj %/weave -o %/x.glb --method sweep --passes 0", "passes 0 must be 1 or more"),
        ("surface %/ball.obj %/weave -o %/x.glb --method sweep --start here", "unknown start 'here': choose blocks or"),
        ("surface %/ball.obj %/weave -o %/x.glb --method sweep --shape disc", "unknown shape 'disc'"),
        ("surface %/ball.obj %/weave -o %/x.glb --method sweep --order scan-line", "unknown order 'scan-line'"),
        ("surface %/ball.obj %/weave -o %/x.glb --method sweep --search pca", "unknown search 'pca'"),
        ("surface %/ball.obj %/weave -o %/x.glb --preset sweep --method optimize", "--preset sweep has no optimize"),
        ("surface %/two.ply %/weave %/scales -o %/x.glb --fuse vertex --method sweep", "cannot continue one"),
        ("surface %/ball.obj %/weave %/scales -o %/x.glb --fuse vertex --preset sweep", "exclude each other"),
        ("fill %/weave/basecolor.png -o %/x.png --mask %/weave/basecolor.png --method sweep", "unknown method 'sweep'"),
    ],
)
def test_what_does_not_go_is_told_in_one_line(words: str, message: str, folder: Path, capsys: Captured) -> None:
    assert message in refused(folder, words, capsys)
    assert not list(folder.glob("x.*"))
