"""The examples of docs/extend.md run as they stand."""

import re
from pathlib import Path

import numpy as np

from texloom.demo import rabbit
from texloom.domain.surface import Surface
from texloom.field.direction import from_constant
from texloom.synthesis.synthesize import synthesize

PAGE = Path(__file__).parents[2] / "docs" / "extend.md"


def test_the_example_method_runs_on_a_grid_and_on_a_mesh() -> None:
    names: dict = {"__name__": "docs.extend"}
    for block in re.findall(r"```python\n(.*?)```", PAGE.read_text(encoding="utf-8"), re.DOTALL):
        exec(block, names)
    assert names["maps"]["basecolor"].image.shape == (96, 160, 3)
    assert names["maps"]["basecolor"].image.std() > 0.05

    mesh = rabbit(step=0.12)
    surface = Surface.build(mesh, from_constant(mesh, 1, np.array([0.0, 1.0, 0.0])), texel=0.05)
    result = synthesize(names["sample"], surface, names["Scatter"](patch=12), seed=1)
    assert result.sources.count == surface.count and np.isfinite(result.sources.position).all()
