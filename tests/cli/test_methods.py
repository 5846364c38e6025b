import pytest

from texloom.cli.methods import wish
from texloom.cli.options import METHODS, PRESETS, SEARCHES
from texloom.search import SEARCHES as LIBRARY_SEARCHES
from texloom.synthesis.boundary import BoundarySampling
from texloom.synthesis.least_squares import LeastSquares
from texloom.synthesis.optimize import Optimize
from texloom.synthesis.patches import PatchSampling


def test_the_names_are_those_of_the_library() -> None:
    assert tuple(LIBRARY_SEARCHES) == SEARCHES


def test_ours_unless_a_preset_is_named() -> None:
    assert isinstance(wish(None, None, None).build(), Optimize)
    assert isinstance(wish("patches", None, None).build(), PatchSampling)


@pytest.mark.parametrize(("method", "kind"), list(zip(METHODS, (LeastSquares, BoundarySampling), strict=True)))
@pytest.mark.parametrize("search", SEARCHES)
def test_the_papers_methods_take_any_search(method: str, kind: type, search: str) -> None:
    built = wish(method, search, PRESETS[0]).build()
    assert isinstance(built, LeastSquares | BoundarySampling) and type(built) is kind
    assert built.search == LIBRARY_SEARCHES[search]
