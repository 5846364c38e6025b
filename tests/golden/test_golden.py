"""One small picture a method, kept as sources: what changes a picture must be meant.

Sources must be equal at 99 of 100 sites, not at all, since near ties may fall otherwise on another machine. Where a
change is meant, look at the new pictures, then keep them with

    .venv/bin/python -m tests.golden.test_golden
"""

import tempfile
from pathlib import Path

import numpy as np
import pytest
from numpy import ndarray
from PIL import Image

from texloom.domain.grid import Grid
from texloom.exemplar.colour import encode
from texloom.exemplar.exemplar import Exemplar, from_array
from texloom.output.gather import gather_sites
from texloom.sources import SourceMap
from texloom.synthesis.boundary import BoundarySampling
from texloom.synthesis.least_squares import LeastSquares
from texloom.synthesis.optimize import Optimize
from texloom.synthesis.patches import PatchSampling
from texloom.synthesis.refine import Refine
from texloom.synthesis.synthesize import Method, synthesize

HERE = Path(__file__).parent
GRID = Grid(64, 64, wrap=True)
EQUAL = 0.99  # of the sites
TOLERANCE = 2.0  # of 255, mean difference of the pictures

METHODS: dict[str, Method] = {
    "optimize": Optimize(),
    "patches": PatchSampling(),
    "refine": Refine(),
    "refine-scan-line": Refine(order="scan-line"),
    "least-squares": LeastSquares(),
    "boundary": BoundarySampling(patch=16),
}


def sample() -> Exemplar:
    """The picture beside this file: demo pebbles at a third of their size, kept as they were when chosen."""
    with Image.open(HERE / "sample.png") as image:
        return from_array(np.asarray(image))


def grown(name: str) -> SourceMap:
    return synthesize(sample(), GRID, METHODS[name], seed=1).sources


def kept(name: str) -> SourceMap:
    with np.load(HERE / f"{name}.npz") as file:
        weight = file["weight"].astype(np.float32)
        return SourceMap(file["position"].astype(np.float32), weight / weight.sum(1, keepdims=True))


def keep(name: str, sources: SourceMap) -> None:
    """Whole positions and weights in 255ths, which is all a grid's sources need."""
    position, weight = sources.position.astype(np.int16), np.rint(sources.weight * 255).astype(np.uint8)
    assert (position == sources.position).all()
    np.savez_compressed(HERE / f"{name}.npz", position=position, weight=weight)


def picture(sources: SourceMap) -> ndarray:
    """As stored: 8-bit."""
    colours = encode(gather_sites(sources, sample().lead))
    return np.rint(255 * np.clip(colours, 0, 1)).astype(np.uint8).reshape(*GRID.shape, -1)


def compare(result: SourceMap, reference: SourceMap) -> None:
    """Raises: AssertionError, with the folder of the pictures, if the sources or the pictures differ too much."""
    same = float((result.position[:, 0] == reference.position[:, 0]).all(1).mean())
    ours, theirs = picture(result), picture(reference)
    apart = np.abs(ours.astype(int) - theirs)
    if same >= EQUAL and apart.mean() <= TOLERANCE:
        return
    folder = Path(tempfile.mkdtemp(prefix="texloom-golden-"))
    for name, image in {"result": ours, "reference": theirs, "difference": apart.astype(np.uint8)}.items():
        Image.fromarray(image).resize((256, 256), Image.Resampling.NEAREST).save(folder / f"{name}.png")
    raise AssertionError(
        f"{100 * same:.1f} % of the sites show their kept source (99 needed), pictures differ by {apart.mean():.1f} of "
        f"255: see {folder}; keep the new pictures with: python -m tests.golden.test_golden"
    )


@pytest.mark.parametrize("name", METHODS)
def test_the_picture_is_the_one_kept(name: str) -> None:
    compare(grown(name), kept(name))


def test_a_difference_is_drawn_into_a_folder_that_the_message_names() -> None:
    reference = kept("optimize")
    moved = SourceMap(np.roll(reference.position, 5, axis=0), reference.weight)
    with pytest.raises(AssertionError, match="see .*texloom-golden-") as caught:
        compare(moved, reference)
    folder = Path(str(caught.value).split("see ")[1].split(";")[0])
    assert sorted(path.name for path in folder.iterdir()) == ["difference.png", "reference.png", "result.png"]
    for path in folder.iterdir():
        path.unlink()
    folder.rmdir()


if __name__ == "__main__":
    for method in METHODS:
        keep(method, grown(method))
        print(f"kept {method}")
