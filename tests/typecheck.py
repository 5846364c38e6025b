"""The runtime type checker of the test suite, named to pytest by the Makefile."""

from collections.abc import Callable
from typing import Any

import numpy as np
from beartype import BeartypeConf, FrozenDict, beartype
from beartype.roar import BeartypeDecorHintPep3119Exception

_NUMBERS = FrozenDict({float: float | int | np.floating, int: int | np.integer})
_check = beartype(conf=BeartypeConf(hint_overrides=_NUMBERS))


def checked(function: Callable[..., Any]) -> Callable[..., Any]:
    """The function with its arguments checked; as it is where a hint, such as a plain Protocol, cannot be."""
    try:
        return _check(function)
    except BeartypeDecorHintPep3119Exception:
        return function
