import re
import xml.etree.ElementTree as Xml

import pytest
from hypothesis import given
from hypothesis import strategies as st

from texloom.output.plots import bar_plot, curve_plot, line_plot, nice_ticks

numbers = st.floats(-1e6, 1e6, allow_nan=False).map(lambda value: round(value, 6))


@given(numbers, numbers)
def test_ticks_are_round_and_reach_around(one: float, other: float) -> None:
    low, high = min(one, other), max(one, other)
    ticks = nice_ticks(low, high)
    if len(ticks) == 1:
        assert high == pytest.approx(low, rel=1e-8)
        return
    steps = [b - a for a, b in zip(ticks, ticks[1:], strict=False)]
    assert 2 <= len(ticks) <= 7 and ticks[0] <= low + 1e-6 * steps[0] and ticks[-1] >= high - 1e-6 * steps[0]
    assert f"{steps[0]:.0e}"[0] in "125" and steps == pytest.approx([steps[0]] * len(steps), rel=1e-3)


@pytest.mark.parametrize("values", [[1.0], [2.0, 2.0], [3.0, 2.0, 2.5], [0.0], [5.0] * 40])
def test_a_line_stays_inside_and_is_lower_where_values_are(values: list[float]) -> None:
    svg = line_plot(values, across="pass")
    Xml.fromstring(svg)
    points = re.search(r'points="([^"]*)"', svg)
    assert points is not None
    places = [tuple(map(float, point.split(","))) for point in points[1].split()]
    assert len(places) == len(values)
    assert all(0 <= x <= 640 and 0 <= y <= 220 for x, y in places)
    assert sorted(range(len(values)), key=lambda i: (values[i], i)) == sorted(
        range(len(values)), key=lambda i: (-places[i][1], i)
    )


def test_bars_are_as_long_as_their_values() -> None:
    svg = bar_plot({"read & write": 1.0, "blocks": 4.0, "nothing": 0.0}, unit="s")
    Xml.fromstring(svg)
    lengths = [float(width) for width in re.findall(r'width="([\d.]+)"', svg)]
    assert lengths[1] == pytest.approx(4 * lengths[0], rel=1e-2) and lengths[2] == 1.0
    assert "read &amp; write" in svg and "4.00 s" in svg


def test_a_marked_place_is_where_its_peak_is_drawn() -> None:
    along = [2.0, 4.0, 8.0, 32.0]
    svg = curve_plot(along, [0.0, 1.0, 5.0, 2.0], across="texels", mark=(8.0, "8 & more"))
    Xml.fromstring(svg)
    points = re.search(r'points="([^"]*)"', svg)
    assert points is not None and "8 &amp; more" in svg
    places = [tuple(map(float, point.split(","))) for point in points[1].split()]
    assert min(places, key=lambda place: place[1]) == places[2]
    assert f'd="M{places[2][0]:.1f} ' in svg
    steps = [b[0] - a[0] for a, b in zip(places, places[1:], strict=False)]
    assert steps == pytest.approx([steps[0], steps[0], 2 * steps[0]], abs=0.2)
    assert all(0 <= x <= 640 and 0 <= y <= 260 for x, y in places)
