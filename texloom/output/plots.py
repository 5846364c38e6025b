"""Small plots as inline SVG that stand alone, in the page's own ink: a line over passes, a curve over scales, bars."""

from collections.abc import Iterable, Mapping, Sequence
from html import escape
from math import ceil, floor, log2, log10

_WIDTH = 640  # of every plot, in its own units
_LEFT, _RIGHT, _TOP, _BOTTOM = 76, 16, 12, 34  # room for labels
_BAR = 26  # height of a bar with its gap
_MARK = "#4a7fb5"  # of lines and bars, on light pages and on dark ones


def line_plot(values: Sequence[float], *, across: str, height: int = 220) -> str:
    """Values by their number, counted from 1, on an axis that just holds them."""
    ticks = nice_ticks(min(values), max(values))
    low, high = min(ticks[0], *values), max(ticks[-1], *values)
    inner, tall = _WIDTH - _LEFT - _RIGHT, height - _TOP - _BOTTOM

    def place(number: int, value: float) -> tuple[float, float]:
        share = number / max(len(values) - 1, 1) if len(values) > 1 else 0.5
        return _LEFT + inner * share, _TOP + tall * (1 - (value - low) / ((high - low) or 1.0))

    parts = _rules((tick, place(0, tick)[1]) for tick in ticks)
    dots = [place(number, value) for number, value in enumerate(values)]
    parts.append(_polyline(dots))
    for number, (x, y) in enumerate(dots, 1):
        title = f"<title>{number}: {values[number - 1]:.4g}</title>"
        radius = 4 if len(dots) < 20 else 2
        parts.append(f'<circle cx="{x:.1f}" cy="{y:.1f}" r="{radius}" fill="{_MARK}">{title}</circle>')
    for number in sorted({1, len(values)}):
        parts.append(_text(dots[number - 1][0], height - _BOTTOM + 18, str(number), anchor="middle"))
    parts.append(_text(_LEFT + inner / 2, height - 4, across, anchor="middle", opacity=0.6))
    return _svg(height, parts)


def curve_plot(
    along: Sequence[float], values: Sequence[float], *, across: str, mark: tuple[float, str], height: int = 260
) -> str:
    """Values (0 or more) over positive, rising places on an axis of powers of two, one place marked and named."""
    first, last = log2(along[0]), log2(along[-1])
    ticks = nice_ticks(0.0, max(values))
    high = max(ticks[-1], *values) or 1.0
    inner, floor_y, top = _WIDTH - _LEFT - _RIGHT, height - _BOTTOM - 8, _TOP + 16  # room for labels

    def x(place: float) -> float:
        return _LEFT + inner * (log2(place) - first) / ((last - first) or 1.0)

    def y(value: float) -> float:
        return floor_y - (floor_y - top) * value / high

    parts = _rules((tick, y(tick)) for tick in ticks)
    parts.append(_polyline([(x(place), y(value)) for place, value in zip(along, values, strict=True)]))
    for power in range(ceil(first), floor(last) + 1):
        parts.append(_text(x(2.0**power), floor_y + 18, f"{2.0**power:g}", anchor="middle"))
    where, name = mark
    line = f"M{x(where):.1f} {top - 6}V{floor_y}"
    parts.append(f'<path d="{line}" stroke="{_MARK}" stroke-dasharray="4 3" fill="none"/>')
    anchor = "end" if x(where) > _LEFT + inner * 0.6 else "start"
    parts.append(_text(x(where), top - 11, name, anchor=anchor))
    parts.append(_text(_LEFT + inner / 2, height - 4, across, anchor="middle", opacity=0.6))
    return _svg(height, parts)


def bar_plot(values: Mapping[str, float], *, unit: str) -> str:
    """One bar a value, from 0, named at its left and numbered at its right."""
    left, right = 150, 70
    longest = max(values.values()) or 1.0
    parts = []
    for row, (name, value) in enumerate(values.items()):
        y = row * _BAR + 4
        length = max((_WIDTH - left - right) * value / longest, 1.0)
        parts.append(_text(left - 10, y + 14, name, anchor="end"))
        parts.append(f'<rect x="{left}" y="{y}" width="{length:.1f}" height="{_BAR - 8}" rx="2" fill="{_MARK}"/>')
        parts.append(_text(left + length + 8, y + 14, f"{value:.2f} {unit}", opacity=0.6))
    return _svg(len(values) * _BAR + 4, parts)


def nice_ticks(low: float, high: float, *, about: int = 4) -> list[float]:
    """Round numbers (1, 2 or 5 times a power of ten apart) that reach around ``low`` and ``high``."""
    if high - low <= 1e-9 * max(abs(low), abs(high)):
        return [low]
    raw = (high - low) / about
    power = 10.0 ** floor(log10(raw))
    step = next(power * factor for factor in (1, 2, 5, 10) if power * factor >= raw * (1 - 1e-9))
    return [step * number for number in range(floor(low / step), ceil(high / step) + 1)]


def _rules(ticks: Iterable[tuple[float, float]]) -> list[str]:
    """Level lines with their values at the left."""
    parts = []
    for value, y in ticks:
        parts.append(f'<path d="M{_LEFT} {y:.1f}H{_WIDTH - _RIGHT}" stroke="currentColor" stroke-opacity="0.15"/>')
        parts.append(_text(_LEFT - 8, y + 4, f"{value:.4g}", anchor="end"))
    return parts


def _polyline(dots: Sequence[tuple[float, float]]) -> str:
    points = " ".join(f"{x:.1f},{y:.1f}" for x, y in dots)
    return f'<polyline points="{points}" fill="none" stroke="{_MARK}" stroke-width="2"/>'


def _text(x: float, y: float, text: str, *, anchor: str = "start", opacity: float = 1.0) -> str:
    place = f'x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}"'
    return f'<text {place} font-size="12" fill="currentColor" fill-opacity="{opacity}">{escape(text)}</text>'


def _svg(height: int, parts: Sequence[str]) -> str:
    return f'<svg viewBox="0 0 {_WIDTH} {height}" role="img">{"".join(parts)}</svg>'
