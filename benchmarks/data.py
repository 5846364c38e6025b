"""Where the exemplars, stacks and meshes are: beside the checkout, or where ``TEXLOOM_DATA`` says."""

import os
from pathlib import Path

DATA = Path(os.environ.get("TEXLOOM_DATA") or Path(__file__).parents[2] / "shared" / "data")

SAMPLES = (
    "beans-192",
    "bricks-brown-192",
    "granite-white-128",
    "grass-green-290x272",
    "mud-cracked-400",
    "olives-242",
    "pebbles-grey-242",
    "scales-green-cells-192",
    "stones-flagstone-192",
    "weave-wood-basket-192",
)
SEED = 7
