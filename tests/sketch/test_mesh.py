import numpy as np
import pytest

from tests.data import DATA, needs_data
from tests.sketch.drawn import voronoi
from texloom.errors import ParameterError
from texloom.io.svg import read_svg
from texloom.sketch.mesh.scale import cell_size
from texloom.sketch.mesh.texture_mesh import TextureMesh
from texloom.sketch.reading.strokes import graph_of


def test_stages_run_alone_and_give_what_all_give_at_once() -> None:
    sketch = voronoi(30, seed=1)
    mesh = TextureMesh(size=(120, 150), radius=12.0)
    whole = mesh.run(sketch, 3)
    patch = mesh.patch(sketch, 3)
    tiling = mesh.tiled(patch)
    staged = mesh.refined(tiling, 3)
    np.testing.assert_array_equal(whole.vertices, staged.vertices)
    np.testing.assert_array_equal(whole.curve, staged.curve)
    other = TextureMesh(size=(120, 150), radius=4.0).refined(tiling, 3)
    assert not np.array_equal(staged.vertices, other.vertices)
    np.testing.assert_array_equal(
        mesh.refined(tiling, 3).vertices, staged.vertices
    )  # the stages were left as they were


@pytest.mark.parametrize("tileable", [False, True])
def test_the_mesh_is_as_large_as_asked(tileable: bool) -> None:
    graph = TextureMesh(size=(90, 130), tileable=tileable).run(voronoi(30, seed=1), 0)
    assert graph.wrap == tileable
    np.testing.assert_allclose(graph.size, (90, 130))
    low, high = graph.vertices.min(axis=0), graph.vertices.max(axis=0)
    assert tileable or ((low < -0.5).all() and (high > (89.5, 129.5)).all())


@pytest.mark.parametrize(
    ("wrong", "says"),
    [
        ({"size": (0, 5)}, "5×0 texels"),
        ({"scale": 0.0}, "scale 0"),
        ({"radius": -1.0}, "radius -1"),
        ({"iterations": -2}, "iterations -2"),
        ({"strength": 1.5}, "between 0 and 1"),
    ],
)
def test_what_makes_no_sense_is_refused(wrong: dict, says: str) -> None:
    with pytest.raises(ParameterError, match=says):
        TextureMesh(**{"size": (64, 64), **wrong})


@needs_data
@pytest.mark.parametrize("name", sorted(path.stem for path in (DATA / "sketches").glob("*.svg")))
def test_every_sketch_becomes_a_mesh(name: str) -> None:
    sketch, _ = graph_of(read_svg(DATA / "sketches" / f"{name}.svg"))
    patch = TextureMesh(size=(1, 1)).patch(sketch, 0)
    assert not patch.mirrored and patch.note is None
    for radius in (5.0, 15.0, 25.0):
        mesh = TextureMesh(size=(200, 256), scale=0.5, radius=radius, tileable=radius == 15)
        graph = mesh.refined(mesh.tiled(patch), 0)
        assert not len(graph.crossings())
        assert len(graph.cells()) > 20


def test_cells_are_as_large_as_asked_and_stray_by_a_quarter():
    sketch = voronoi(30, seed=2)
    own = cell_size(sketch)
    as_drawn, as_asked = TextureMesh.of(sketch, (90, 80)), TextureMesh.of(sketch, (90, 80), cell=3 * own, tileable=True)
    assert (as_drawn.scale, as_drawn.radius, as_drawn.tileable) == (1, own / 4, False)
    np.testing.assert_allclose((as_asked.scale, as_asked.radius), (3, 0.75 * own))
    assert as_asked.tileable and as_asked.size == (90, 80)
    assert TextureMesh.of(sketch, (90, 80), cell=8, scale=0.5, radius=2) == TextureMesh(
        size=(90, 80), scale=0.5, radius=2
    )
