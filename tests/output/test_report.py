"""A report is one page that needs nothing else."""

import base64
import io
from html.parser import HTMLParser
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from texloom.errors import FileError
from texloom.output.report import Account, Figure, fitted, report_html, write_report

VOID = {"meta", "img", "br"}


class Page(HTMLParser):
    """Tags that are closed in order, attributes and text."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.open: list[str] = []
        self.attributes: list[tuple[str, str, str | None]] = []
        self.text: list[str] = []
        self.feed(text)
        assert self.open == []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.attributes += [(tag, name, value) for name, value in attrs]
        if tag not in VOID:
            self.open.append(tag)

    def handle_startendtag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.attributes += [(tag, name, value) for name, value in attrs]

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag

    def handle_data(self, data: str) -> None:
        self.text.append(data)


def account(**parts: object) -> Account:
    picture = np.arange(8 * 5 * 3, dtype=np.uint8).reshape(8, 5, 3)
    whole = {
        "title": "Image from <moss>.png",
        "subtitle": "seed 3",
        "command": 'texloom image "<moss>.png" -o a&b.png',
        "settings": {"seed": "3", "note": "1 < 2"},
        "figures": {"Sample": [Figure(picture, "basecolor")], "Nothing": []},
        "scores": {"swd": 1.234, "own": 2.0},
        "energy": (3.0, 2.0, 1.5),
        "seconds": {"read": 0.5, "write": 0.0},
    }
    return Account(**(whole | parts))  # pyright: ignore[reportArgumentType]


def test_the_page_is_whole_and_stands_alone() -> None:
    html = report_html(account())
    page = Page(html)
    assert not [tag for tag, *_ in page.attributes if tag in ("script", "link", "iframe", "object")]
    assert "http" not in html and "url(" not in html and "@import" not in html
    for _, name, value in page.attributes:
        assert not name.startswith("on") and name != "href"
        assert name != "src" or (value or "").startswith("data:image/png;base64,")


def test_text_is_shown_as_it_is() -> None:
    text = "\n".join(Page(report_html(account())).text)
    for said in (
        'texloom image "<moss>.png" -o a&b.png',
        "Image from <moss>.png",
        "1 < 2",
        "basecolor",
        "1.23",
        "0.50 s",
    ):
        assert said in text
    assert "Nothing" not in text


def test_pictures_come_back_pixel_by_pixel() -> None:
    figure = account().figures["Sample"][0]
    source = next(
        value for tag, name, value in Page(report_html(account())).attributes if (tag, name) == ("img", "src")
    )
    assert source is not None
    decoded = Image.open(io.BytesIO(base64.b64decode(source.partition(",")[2])))
    np.testing.assert_array_equal(np.asarray(decoded), figure.picture)


def test_what_is_empty_is_left_out() -> None:
    text = Page(report_html(account(scores={}, energy=(), seconds={}))).text
    assert not {"Scores", "Energy", "Seconds"} & set(text) and "Do it again" in text
    assert "too small" in "".join(Page(report_html(account(scores={}, remark="too small"))).text)


@pytest.mark.parametrize("channels", [1, 3])
def test_large_pictures_are_made_smaller_as_a_whole(channels: int) -> None:
    picture = np.tile(np.arange(200, dtype=np.uint8)[:, None, None], (1, 100, channels))
    small = fitted(picture, 50)
    assert small.shape == (50, 25, channels)
    np.testing.assert_allclose(small[:, 0, 0], np.arange(200).reshape(50, 4).mean(1), atol=1)
    assert fitted(picture, 200) is picture


def test_it_is_written_whole_or_not_at_all(tmp_path: Path) -> None:
    assert write_report(tmp_path / "r.html", account()).read_text(encoding="utf-8") == report_html(account())
    with pytest.raises(FileError, match="there is no folder"):
        write_report(tmp_path / "nowhere" / "r.html", account())
    assert [path.name for path in tmp_path.iterdir()] == ["r.html"]
