"""Planar domains from the options of ``texloom image``."""

from typing import Any


def plane(rows: int, columns: int, *, field: str | None, tileable: bool) -> Any:
    """A plane or torus of sites, along a planar field where one is named."""
    from texloom.domain.grid import Grid

    if field is None:
        return Grid(rows, columns, wrap=tileable)
    raise NotImplementedError
