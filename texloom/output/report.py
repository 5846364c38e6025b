"""One run on one page: pictures, scores, plots and settings in a single HTML file that needs nothing else."""

import base64
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from html import escape
from pathlib import Path

import numpy as np
from jaxtyping import UInt8
from PIL import Image as Pillow

from texloom.output.atomic import atomic
from texloom.output.plots import bar_plot, line_plot
from texloom.output.png import png_bytes

_MEANING = {
    "swd": "same kinds of patches, in the same shares",
    "coherence": "nothing made up: mean difference of the result's patches to the sample's nearest, of 255",
    "completeness": "nothing left out: the same from the sample's patches to the result's",
    "copy": "side of the typical piece copied unchanged, in texels",
    "seam": "step across the borders over steps inside; at most 1 tiles without a seam",
}

_STYLE = """
:root { color-scheme: light dark; --ink: #1c1d21; --soft: #696c76; --rule: #e2e3e8; --page: #fff; }
@media (prefers-color-scheme: dark) {
  :root { --ink: #e8e9ed; --soft: #9a9da8; --rule: #33353c; --page: #17181b; } }
* { box-sizing: border-box; }
body { margin: 0 auto; max-width: 1080px; padding: 40px 28px 80px; background: var(--page); color: var(--ink);
  font: 15px/1.5 system-ui, sans-serif; }
h1 { font-size: 28px; font-weight: 600; margin: 0; } h1 + p { margin: 4px 0 0; color: var(--soft); }
h2 { font-size: 17px; font-weight: 600; margin: 44px 0 14px; padding-top: 14px; border-top: 1px solid var(--rule); }
.figures { display: flex; flex-wrap: wrap; gap: 18px; }
figure { margin: 0; }
.two figure { width: calc(50% - 9px); } .many figure { width: calc(16.66% - 15px); min-width: 110px; }
figure img { display: block; width: 100%; height: auto; border-radius: 3px; } .one img { width: auto; max-width: 100%; }
figcaption { margin-top: 6px; color: var(--soft); font-size: 13px; }
table { border-collapse: collapse; width: 100%; }
th, td { padding: 6px 16px 6px 0; border-bottom: 1px solid var(--rule); text-align: left; vertical-align: top; }
th { font-weight: 500; white-space: nowrap; width: 1%; } td { overflow-wrap: anywhere; }
td.number { width: 1%; white-space: nowrap; overflow-wrap: normal; font-variant-numeric: tabular-nums; }
td.soft, p.soft { color: var(--soft); }
pre { background: color-mix(in srgb, var(--rule) 45%, transparent); padding: 12px 14px; border-radius: 4px;
  white-space: pre-wrap; overflow-wrap: anywhere; font: 13px/1.5 ui-monospace, monospace; margin: 0 0 18px; }
svg { display: block; width: 100%; max-width: 760px; }
"""


@dataclass(frozen=True, eq=False)
class Figure:
    """A picture as it is stored, 8 bits a channel, and what it shows."""

    picture: UInt8[np.ndarray, "row column channel"]
    caption: str


@dataclass(frozen=True, eq=False, kw_only=True)
class Account:
    """What a report tells of one run; what is empty is left out."""

    title: str
    subtitle: str
    command: str  # line that repeats it
    settings: Mapping[str, str]
    figures: Mapping[str, Sequence[Figure]]  # by heading
    scores: Mapping[str, float] = field(default_factory=dict)
    remark: str = ""  # below the scores
    energy: Sequence[float] = ()
    plots: Mapping[str, str] = field(default_factory=dict)  # further ones, as inline SVG by heading
    seconds: Mapping[str, float] = field(default_factory=dict)


def write_report(path: str | Path, account: Account) -> Path:
    """Write the page, whole or not at all."""
    path = Path(path)
    with atomic(path) as beside:
        beside.write_text(report_html(account), encoding="utf-8")
    return path


def report_html(account: Account) -> str:
    """The page: pictures inside as PNG, plots as SVG, no scripts, no links."""
    body = [f"<h1>{escape(account.title)}</h1><p>{escape(account.subtitle)}</p>"]
    body += [_section(heading, _figures(figures)) for heading, figures in account.figures.items() if figures]
    if account.scores or account.remark:
        body.append(_section("Scores", _scores(account.scores) + _soft(account.remark)))
    if account.energy:
        body.append(_section("Energy", line_plot(account.energy, across="pass")))
    body += [_section(heading, plot) for heading, plot in account.plots.items()]
    if account.seconds:
        body.append(_section("Seconds", bar_plot(account.seconds, unit="s")))
    rows = [_row(name, value) for name, value in account.settings.items()]
    body.append(_section("Do it again", f"<pre>{escape(account.command)}</pre>{_table(rows)}"))
    head = '<meta charset="utf-8"><meta name="viewport" content="width=device-width">'
    head += f"<title>{escape(account.title)}</title><style>{_STYLE}</style>"
    lines = ["<!doctype html>", f'<html lang="en"><head>{head}</head>', "<body>", *body, "</body></html>", ""]
    return "\n".join(lines)


def fitted(picture: UInt8[np.ndarray, "row column channel"], side: int) -> UInt8[np.ndarray, "row2 column2 channel"]:
    """The picture, made smaller where a side is longer than ``side`` pixels."""
    rows, columns, channels = picture.shape
    share = side / max(rows, columns)
    if share >= 1:
        return picture
    size = (max(1, round(columns * share)), max(1, round(rows * share)))
    flat = Pillow.fromarray(picture[..., 0] if channels == 1 else picture)
    return np.asarray(flat.resize(size, Pillow.Resampling.BOX)).reshape(size[1], size[0], channels)


def _section(heading: str, content: str) -> str:
    return f"<section><h2>{escape(heading)}</h2>{content}</section>"


def _figures(figures: Sequence[Figure]) -> str:
    """One picture in its own size, two side by side, more in a grid."""
    shown = [
        f'<figure><img alt="{escape(figure.caption)}" src="{_inline(figure.picture)}">'
        f"<figcaption>{escape(figure.caption)}</figcaption></figure>"
        for figure in figures
    ]
    layout = {1: "one", 2: "two"}.get(len(shown), "many")
    return f'<div class="figures {layout}">{"".join(shown)}</div>'


def _inline(picture: UInt8[np.ndarray, "row column channel"]) -> str:
    """A picture as a URI that holds it."""
    return "data:image/png;base64," + base64.b64encode(png_bytes(np.ascontiguousarray(picture))).decode("ascii")


def _scores(scores: Mapping[str, float]) -> str:
    return _table([_row(name, f"{value:.2f}", _MEANING.get(name, "")) for name, value in scores.items()])


def _row(name: str, value: str, remark: str | None = None) -> str:
    """A line of a table; with a remark the value is a number."""
    kind, beside = ("", "") if remark is None else (' class="number"', f'<td class="soft">{escape(remark)}</td>')
    return f"<tr><th>{escape(name)}</th><td{kind}>{escape(value)}</td>{beside}</tr>"


def _table(rows: Sequence[str]) -> str:
    return f"<table>{''.join(rows)}</table>" if rows else ""


def _soft(text: str) -> str:
    return f'<p class="soft">{escape(text)}</p>' if text else ""
