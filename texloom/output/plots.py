"""Small plots as inline SVG: a line over passes, bars of seconds. Colours come from the page's style."""

from collections.abc import Mapping, Sequence
from html import escape
from math import ceil, floor, log10

_WIDTH = 640  # of every plot, in its own units
_LEFT, _RIGHT, _TOP, _BOTTOM = 76, 16, 12, 34  # room for labels
_BAR = 26  # height of a bar with its gap


def line_plot(values: Sequence[float], *, across: str, height: int = 220) -> str:
    """Values by their number, counted from 1, on an axis that just holds them."""
    ticks = nice_ticks(min(values), max(values))
    low, high = min(ticks[0], *values), max(ticks[-1], *values)
    inner, tall = _WIDTH - _LEFT - _RIGHT, height - _TOP - _BOTTOM

    def place(number: int, value: float) -> tuple[float, float]:
        share = number / max(len(values) - 1, 1) if len(values) > 1 else 0.5
        return _LEFT + inner * share, _TOP + tall * (1 - (value - low) / ((high - low) or 1.0))

    parts = []
    for tick in ticks:
        y = place(0, tick)[1]
        parts.append(f'<line class="grid" x1="{_LEFT}" x2="{_WIDTH - _RIGHT}" y1="{y:.1f}" y2="{y:.1f}"/>')
        parts.append(f'<text class="end" x="{_LEFT - 8}" y="{y + 4:.1f}">{tick:.4g}</text>')
    dots = [place(number, value) for number, value in enumerate(values)]
    parts.append(f'<polyline class="line" points="{" ".join(f"{x:.1f},{y:.1f}" for x, y in dots)}"/>')
    for number, (x, y) in enumerate(dots, 1):
        title = f"<title>{number}: {values[number - 1]:.4g}</title>"
        parts.append(f'<circle class="dot" cx="{x:.1f}" cy="{y:.1f}" r="{4 if len(dots) < 20 else 2}">{title}</circle>')
    for number in sorted({1, len(values)}):
        x = dots[number - 1][0]
        parts.append(f'<text class="middle" x="{x:.1f}" y="{height - _BOTTOM + 18}">{number}</text>')
    middle = _LEFT + inner / 2
    parts.append(f'<text class="middle soft" x="{middle:.0f}" y="{height - 4}">{escape(across)}</text>')
    return _svg(height, parts)


def bar_plot(values: Mapping[str, float], *, unit: str) -> str:
    """One bar a value, from 0, named at its left and numbered at its right."""
    left, right = 150, 70
    longest = max(values.values()) or 1.0
    parts = []
    for row, (name, value) in enumerate(values.items()):
        y = row * _BAR + 4
        length = max((_WIDTH - left - right) * value / longest, 1.0)
        parts.append(f'<text class="end" x="{left - 10}" y="{y + 14}">{escape(name)}</text>')
        parts.append(f'<rect class="bar" x="{left}" y="{y}" width="{length:.1f}" height="{_BAR - 8}" rx="2"/>')
        parts.append(f'<text class="soft" x="{left + length + 8:.1f}" y="{y + 14}">{value:.2f} {escape(unit)}</text>')
    return _svg(len(values) * _BAR + 4, parts)


def nice_ticks(low: float, high: float, *, about: int = 4) -> list[float]:
    """Round numbers (1, 2 or 5 times a power of ten apart) that reach around ``low`` and ``high``."""
    if high - low <= 1e-9 * max(abs(low), abs(high)):
        return [low]
    raw = (high - low) / about
    power = 10.0 ** floor(log10(raw))
    step = next(power * factor for factor in (1, 2, 5, 10) if power * factor >= raw * (1 - 1e-9))
    return [step * number for number in range(floor(low / step), ceil(high / step) + 1)]


def _svg(height: int, parts: Sequence[str]) -> str:
    return f'<svg viewBox="0 0 {_WIDTH} {height}" role="img">{"".join(parts)}</svg>'
