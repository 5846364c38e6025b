"""The tools people use today, run as a fair user would: default settings, the whole sample."""

import contextlib
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
from PIL import Image

Peer = Callable[[Image.Image, int], Image.Image]


def gmic(sample: Image.Image, size: int) -> Image.Image:
    """G'MIC ``syntexturize_matchpatch`` with its defaults, seeded for the same picture each time."""
    import gmic as module

    with tempfile.TemporaryDirectory() as folder:
        source, target = Path(folder, "sample.png"), Path(folder, "result.png")
        sample.save(source)
        module.run(f"srand 7 {source} syntexturize_matchpatch {size},{size} round cut 0,255 output {target}")
        with Image.open(target) as result:
            return result.convert("RGB")


def resynthesizer(sample: Image.Image, size: int) -> Image.Image:
    """Resynthesizer, filling everything but the sample in a canvas that holds both side by side.

    It synthesizes *within* a picture, so the sample lies in the last corner of the canvas and the first ``size`` ×
    ``size`` texels, all of them filled, are the result. What is above the sample is filled too and counts in the time.
    Its defaults but one: the tiling flags are off, as they would join the filled part to the sample around the
    canvas's borders; off, its scores are better and its time shorter.
    """
    from resynthesizer.resynthesizer import getDefaultParams, resynthesize

    width, height = sample.size
    canvas = Image.new("RGB", (size + width, max(size, height)))
    mask = Image.new("L", canvas.size, 255)
    corner = (size, canvas.height - height)
    canvas.paste(sample, corner)
    mask.paste(0, (*corner, *canvas.size))
    parameters = getDefaultParams()
    parameters.isMakeSeamlesslyTileableHorizontally = parameters.isMakeSeamlesslyTileableVertically = 0
    return resynthesize(canvas, mask, parameters).crop((0, 0, size, size))


PEERS: dict[str, Peer] = {"gmic": gmic, "resynthesizer": resynthesizer}


def timed(peer: Peer, sample: Image.Image, size: int) -> tuple[np.ndarray, float]:
    """The result and the seconds it took."""
    start = time.perf_counter()
    with contextlib.redirect_stdout(None):
        result = peer(sample, size)
    return np.asarray(result), time.perf_counter() - start
