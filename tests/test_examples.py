"""Examples stay short, run and give pictures; links in the pages lead somewhere."""

import ast
import re
from pathlib import Path

import numpy as np
import pytest

from examples.__main__ import GALLERY, examples, load

ROOT = Path(__file__).parents[1]
PAGES = [ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md"))]
MOST_LINES = 50
MOST_BYTES, MOST_BYTES_TOGETHER = 300 * 1024, 6 * 1024 * 1024
FASTEST = ("plot_tileable", "plot_stack")

each_example = pytest.mark.parametrize("path", examples(), ids=lambda path: path.stem)
each_page = pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.relative_to(ROOT)))


@each_example
def test_an_example_is_short_and_says_what_it_shows(path: Path) -> None:
    text = path.read_text(encoding="utf-8")
    title, blank, *idea = (ast.get_docstring(ast.parse(text)) or "").splitlines()
    assert len(text.splitlines()) <= MOST_LINES
    assert title.endswith(".") and not blank and idea


@each_example
def test_an_example_imports_and_has_a_picture(path: Path) -> None:
    assert callable(load(path).picture)


@pytest.mark.parametrize("name", FASTEST)
def test_an_example_runs(name: str) -> None:
    path = next(path for path in examples() if path.stem == name)
    picture = load(path).picture(detail=0.25)
    assert picture.dtype == np.uint8 and picture.shape[2] == 3
    assert np.ptp(picture) > 100


@each_example
def test_the_gallery_shows_every_example_and_names_it(path: Path) -> None:
    page = (ROOT / "docs" / "gallery.md").read_text(encoding="utf-8")
    assert f"](gallery/{path.stem.removeprefix('plot_')}.jpg)" in page
    assert f"](../{path.relative_to(ROOT)})" in page


def test_gallery_pictures_are_small_and_all_drawn_by_examples() -> None:
    pictures = sorted(GALLERY.iterdir())
    assert [picture.stem for picture in pictures] == sorted(path.stem.removeprefix("plot_") for path in examples())
    assert max(picture.stat().st_size for picture in pictures) <= MOST_BYTES
    assert sum(picture.stat().st_size for picture in pictures) <= MOST_BYTES_TOGETHER


@each_page
def test_links_lead_somewhere(page: Path) -> None:
    for target in re.findall(r"\]\(([^)\s]+)\)", page.read_text(encoding="utf-8")):
        if re.match(r"[a-z]+:", target):
            continue
        path, _, anchor = target.partition("#")
        file = (page.parent / path).resolve() if path else page
        assert file.exists(), f"{page.name}: {target}"
        if anchor:
            assert anchor in _anchors(file), f"{page.name}: {target}"


@each_page
def test_named_functions_exist(page: Path) -> None:
    """`folder/file.py: name` and `folder/file.py` in the pages are ours, and hold what is named."""
    for path, name in re.findall(r"`([a-z_]+/[a-z_/0-9]+\.py)(?:: ([A-Za-z_]+))?", page.read_text(encoding="utf-8")):
        places = [base / path for base in (ROOT, ROOT / "texloom", ROOT / "examples")]
        found = [place for place in places if place.is_file()]
        assert found, f"{page.name}: {path}"
        assert name in found[0].read_text(encoding="utf-8"), f"{page.name}: {path}: {name}"


def _anchors(page: Path) -> set[str]:
    """The anchors of a page's headings."""
    headings = re.findall(r"^#+ (.+)$", page.read_text(encoding="utf-8"), flags=re.MULTILINE)
    return {re.sub(r"[^a-z0-9 -]", "", heading.lower()).replace(" ", "-") for heading in headings}
