import pytest

from texloom.cli.methods import wish
from texloom.cli.options import PRESET_METHODS, PRESETS, SEARCHES
from texloom.errors import ParameterError
from texloom.search import SEARCHES as LIBRARY_SEARCHES
from texloom.synthesis.boundary import BoundarySampling
from texloom.synthesis.least_squares import LeastSquares
from texloom.synthesis.optimize import Optimize
from texloom.synthesis.patches import PatchSampling
from texloom.synthesis.refine import Refine
from texloom.synthesis.refine_patches import RefinePatches


def test_the_names_are_those_of_the_library() -> None:
    assert tuple(LIBRARY_SEARCHES) == SEARCHES


def test_ours_unless_a_preset_is_named() -> None:
    assert isinstance(wish(None, None, None).build(), Optimize)
    assert isinstance(wish("patches", None, None).build(), PatchSampling)
    assert isinstance(wish("refine-patches", None, None).build(), RefinePatches)
    assert wish("refine", None, None, order="scan-line", pitch=5, window=None).build() == Refine(
        order="scan-line", pitch=5
    )


def test_a_preset_has_its_own_methods_only() -> None:
    with pytest.raises(ParameterError, match="resampling has no refine-patches: choose optimize or patches"):
        wish("refine-patches", None, PRESETS[0])


@pytest.mark.parametrize(
    ("method", "kind"), list(zip(PRESET_METHODS[PRESETS[0]], (LeastSquares, BoundarySampling), strict=True))
)
@pytest.mark.parametrize("search", SEARCHES)
def test_the_papers_methods_take_any_search(method: str, kind: type, search: str) -> None:
    built = wish(method, search, PRESETS[0]).build()
    assert isinstance(built, LeastSquares | BoundarySampling) and type(built) is kind
    assert built.search == LIBRARY_SEARCHES[search]
