"""Where a tile should begin: a torus has no border, so the picture may be cut where the cut shows least."""

from collections.abc import Iterable, Mapping
from dataclasses import replace

import numpy as np
from jaxtyping import Float64

from texloom.arrays import Image
from texloom.exemplar.exemplar import Map
from texloom.sources import SourceMap

Shift = tuple[int, int]


def quiet_start(maps: Iterable[Map]) -> Shift:
    """The row and column before which neighbouring lines differ least, of all maps the one that differs most counting.

    Differences are means over the line, relative to the 99th percentile over all lines of that map.
    """
    images = [m.image for m in maps]
    return _quietest([_steps(image) for image in images]), _quietest([_steps(i.swapaxes(0, 1)) for i in images])


def begin_at(shift: Shift, maps: Mapping[str, Map], sources: SourceMap) -> tuple[dict[str, Map], SourceMap]:
    """The same tile, cut before another row and column: its maps and its sources."""
    rows, columns = next(iter(maps.values())).image.shape[:2]

    def rolled(values: np.ndarray) -> np.ndarray:
        return np.ascontiguousarray(np.roll(values, (-shift[0], -shift[1]), (0, 1)))

    def site_values(values: np.ndarray | None) -> np.ndarray | None:
        return (
            None if values is None else rolled(values.reshape(rows, columns, *values.shape[1:])).reshape(values.shape)
        )

    position, weight = site_values(sources.position), site_values(sources.weight)
    assert position is not None and weight is not None
    moved = SourceMap(position, weight, site_values(sources.turn), site_values(sources.scale))
    return {name: replace(m, image=rolled(m.image)) for name, m in maps.items()}, moved


def _steps(image: Image) -> Float64[np.ndarray, "row"]:
    """Mean absolute difference of every row to the one before it, the last to the first."""
    inner = np.abs(np.diff(image, axis=0)).mean(axis=(1, 2), dtype=np.float64)
    return np.append(np.abs(image[0] - image[-1]).mean(dtype=np.float64), inner)


def _quietest(steps: list[Float64[np.ndarray, "line"]]) -> int:
    """The line whose worst map is best; ties take the first."""
    usual = [max(float(np.percentile(of_map, 99)), 1e-12) for of_map in steps]
    return int(np.max([of_map / by for of_map, by in zip(steps, usual, strict=True)], axis=0).argmin())
