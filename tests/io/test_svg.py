"""Every kind of SVG shape becomes curves where the shape is; what cannot be read says so in one line."""

import numpy as np
import pytest

from texloom.errors import FileError
from texloom.io.svg import read_svg
from texloom.sketch.bezier import points_at

PAGE = '<svg xmlns="http://www.w3.org/2000/svg" width="200" height="100" viewBox="0 0 100 50">{}</svg>'


def write(tmp_path, content: str):
    path = tmp_path / "drawing.svg"
    path.write_text(content)
    return path


def read(tmp_path, shapes: str):
    return read_svg(write(tmp_path, PAGE.format(shapes)))


@pytest.mark.parametrize(
    "shape, ends",
    [
        ('<line x1="1" y1="2" x2="3" y2="4" stroke="red"/>', [(2, 1), (4, 3)]),
        ('<polyline points="1,2 3,4 5,0" stroke="red"/>', [(2, 1), (0, 5)]),
        ('<path d="m1 2 l2 2 q1 1 2 0 t2 0 c1 1 2 1 3 0" stroke="red"/>', [(2, 1), (4, 10)]),
        ('<path d="M1 2 A 3 3 0 0 1 7 2" stroke="red"/>', [(2, 1), (2, 7)]),
        ('<g transform="translate(10 5) rotate(90)" stroke="red"><path d="M0 0 L4 0"/></g>', [(5, 10), (9, 10)]),
        ('<defs><path id="a" d="M0 0L9 9" stroke="red"/></defs><use href="#a" x="20"/>', [(0, 20), (9, 29)]),
    ],
)
def test_strokes_lie_where_they_are_drawn(tmp_path, shape, ends):
    drawn = read(tmp_path, shape)
    assert drawn.size == (100.0, 200.0) and len(drawn) == 1 and not drawn.closed[0]
    np.testing.assert_allclose(drawn.curves[0, 0], 2 * np.array(ends[0]) - 0.5, atol=1e-9)
    np.testing.assert_allclose(drawn.curves[-1, 3], 2 * np.array(ends[1]) - 0.5, atol=1e-9)


@pytest.mark.parametrize(
    "shape",
    [
        '<circle cx="20" cy="10" r="5" stroke="red"/>',
        '<ellipse cx="20" cy="10" rx="5" ry="5" stroke="red"/>',
        '<path d="M15 10 a5 5 0 1 1 10 0 a5 5 0 1 1 -10 0 z" stroke="red"/>',
    ],
)
def test_circles_are_round(tmp_path, shape):
    drawn = read(tmp_path, shape)
    assert drawn.closed.all()
    for t in (0.0, 0.37, 0.8):
        on = points_at(drawn.curves, np.full(len(drawn.curves), t))
        moving = (drawn.curves[:, 0] != drawn.curves[:, 3]).any(axis=1)
        np.testing.assert_allclose(np.hypot(*(on - [19.5, 39.5])[moving].T), 10, rtol=1e-3)


def test_a_quadratic_is_the_same_curve(tmp_path):
    drawn = read(tmp_path, '<path d="M0 0 Q10 20 20 0" stroke="red"/>')
    np.testing.assert_allclose(points_at(drawn.curves, np.array([0.5])), [[20 - 0.5, 20 - 0.5]])


def test_subpaths_are_strokes_and_polygons_close(tmp_path):
    polygon = '<polygon points="1,1 4,1 4,4" stroke="red"/>'
    drawn = read(tmp_path, '<path d="M0 0 h5 v5 z M20 20 l3 3" stroke="red"/>' + polygon)
    assert drawn.closed.tolist() == [True, False, True]
    assert np.diff(drawn.start).tolist() == [3, 1, 3]


def test_only_strokes_count_where_there_are_any(tmp_path):
    page = '<rect width="100%" height="100%" fill="white"/>'
    hidden = '<line x1="0" y1="0" x2="9" y2="9" stroke="red" display="none"/>'
    filled = '<polygon points="1,1 4,1 4,4" fill="blue"/>'
    assert len(read(tmp_path, page + hidden + filled + '<line x1="0" y1="0" x2="9" y2="9" stroke="red"/>')) == 1
    assert len(read(tmp_path, page + hidden + filled)) == 1  # the outline, not the page


def test_a_file_without_size_is_as_large_as_its_viewbox_or_drawing(tmp_path):
    line = '<line x1="0" y1="0" x2="40" y2="30" stroke="red"/>'
    boxed = f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 80 60">{line}</svg>'
    bare = f'<svg xmlns="http://www.w3.org/2000/svg">{line}</svg>'
    assert read_svg(write(tmp_path, boxed)).size == (60.0, 80.0)
    assert read_svg(write(tmp_path, bare)).size == (30.0, 40.0)


@pytest.mark.parametrize(
    "content, says",
    [
        ("", "empty"),
        ("not a drawing", "not an SVG"),
        ("<svg><path d='M0 0", "not an SVG"),
        ("<html><body/></html>", "not an SVG"),
        (PAGE.format(""), "no strokes"),
        (PAGE.format("<text>cells</text>"), "no strokes"),
        (PAGE.format('<path d="M3 3" stroke="red"/>'), "no strokes"),
        (PAGE.format('<path d="M0 0 L1e400 4" stroke="red"/>'), "finite|cannot be drawn"),
    ],
)
def test_what_cannot_be_read_says_so(tmp_path, content, says):
    with pytest.raises(FileError, match=says) as caught:
        read_svg(write(tmp_path, content))
    assert "\n" not in str(caught.value) and "drawing.svg" in str(caught.value)


def test_a_missing_file_is_named(tmp_path):
    with pytest.raises(FileError, match="no such file"):
        read_svg(tmp_path / "none.svg")
