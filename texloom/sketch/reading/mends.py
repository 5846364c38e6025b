"""What was mended in a drawing, and where."""

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Mend:
    """One thing done to a drawing to make it close: what, and its place in the drawing."""

    what: str
    row: float
    column: float

    def __str__(self) -> str:
        return f"{self.what} at row {self.row:.0f}, column {self.column:.0f}"


def mends(did: str, places: np.ndarray, lengths: np.ndarray) -> list[Mend]:
    """One mend for each place, saying its length in texels."""
    return [
        Mend(f"{did} of {length:.0f} texel{'' if round(length) == 1 else 's'}", float(row), float(column))
        for (row, column), length in zip(places.tolist(), lengths.tolist(), strict=True)
    ]
