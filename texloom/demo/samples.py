"""The samples by name."""

from collections.abc import Callable

from texloom.demo.bricks import bricks
from texloom.demo.knit import knit
from texloom.demo.pebbles import pebbles
from texloom.demo.scales import scales
from texloom.demo.weave import weave
from texloom.demo.wood import wood
from texloom.errors import ParameterError
from texloom.exemplar.exemplar import Exemplar

SAMPLES: dict[str, Callable[[int, int], Exemplar]] = {
    "bricks": bricks,
    "knit": knit,
    "pebbles": pebbles,
    "scales": scales,
    "weave": weave,
    "wood": wood,
}


def draw(name: str, *, size: int = 256, seed: int = 0) -> Exemplar:
    """The sample of that name, ``size`` texels square, as a stack of six maps."""
    if name not in SAMPLES:
        raise ParameterError(f"unknown sample {name!r}: choose one of {', '.join(SAMPLES)}")
    return SAMPLES[name](size, seed)
