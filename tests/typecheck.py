"""The runtime type checker of the test suite: ``pytest --jaxtyping-packages=...,tests.typecheck.checked``."""

from collections.abc import Callable
from typing import Any

from beartype import BeartypeConf, beartype
from beartype.roar import BeartypeDecorHintPep3119Exception

_check = beartype(conf=BeartypeConf(is_pep484_tower=True))  # an int is a float


def checked(function: Callable[..., Any]) -> Callable[..., Any]:
    """The function with its arguments checked; as it is where a hint, such as a plain Protocol, cannot be."""
    try:
        return _check(function)
    except BeartypeDecorHintPep3119Exception:
        return function
