"""When has a texture that is refined pass by pass settled? (Shin & Shin 2004, eq. 1 and fig. 7)."""

from collections.abc import Iterator
from dataclasses import dataclass, field
from itertools import islice
from typing import Literal

import numpy as np
from jaxtyping import Bool, Float32

from texloom.synthesis.canvas import Canvas

Difference = Literal["mean", "sum"]
_Shown = tuple[Float32[np.ndarray, "site channel"], Float32[np.ndarray, "site 2"]]

_DARK = 1 / 255  # length of a colour that is not told from black


@dataclass(eq=False)
class Convergence:
    """Follows the passes of a run; keeps what each of them changed."""

    difference: Difference
    threshold: float  # a pass that changes less is the last
    sites: Bool[np.ndarray, "site"] | None = None  # those that may change: what surrounds them counts for nothing
    mse: list[float] = field(default_factory=list)
    changed: list[float] = field(default_factory=list)
    differences: list[float] = field(default_factory=list)

    def follow(self, canvas: Canvas, passes: Iterator[float], most: int) -> tuple[tuple[float, ...], str]:
        """Ask for at most so many passes over the canvas: what each leaves, and whether it "settled" or had to stop."""
        energy: list[float] = []
        before = self._shown(canvas)
        for left in islice(passes, most):
            energy.append(left)
            after = self._shown(canvas)
            self._note(before, after)
            if self.differences[-1] < self.threshold:
                return tuple(energy), "settled"
            before = after
        return tuple(energy), "passes"

    @property
    def curves(self) -> dict[str, tuple[float, ...]]:
        """By name, a value a pass: those of fig. 7, and the difference of eq. 1."""
        named = {"MSE": self.mse, "changed pixels": self.changed, "difference": self.differences}
        return {name: tuple(values) for name, values in named.items() if values}

    def _shown(self, canvas: Canvas) -> _Shown:
        """Copies of what the sites show."""
        if self.sites is None:
            return canvas.colour.copy(), canvas.position.copy()
        return canvas.colour[self.sites], canvas.position[self.sites]

    def _note(self, before: _Shown, after: _Shown) -> None:
        """What a pass changed."""
        (colour, position), (new_colour, new_position) = before, after
        self.mse.append(float(((new_colour - colour) ** 2).sum(1).mean(dtype=np.float64)))
        self.changed.append(float((new_position != position).any(1).sum()))
        self.differences.append(relative_change(colour, new_colour, self.difference))


def relative_change(
    before: Float32[np.ndarray, "site channel"], after: Float32[np.ndarray, "site channel"], difference: Difference
) -> float:
    """Eq. 1: ‖f_i - f_(i-1)‖ / ‖f_(i-1)‖, added over all pixels.

    As printed, by the name "sum", it grows with the picture, and black pixels that change make it infinite. "mean"
    divides by the number of pixels, and by no less than a grey level.
    """
    step, length = (np.sqrt((colour**2).sum(1)) for colour in (after - before, before))
    if difference == "mean":
        return float((step / np.maximum(length, _DARK)).mean(dtype=np.float64))
    moved = step > 0
    with np.errstate(divide="ignore"):
        return float((step[moved] / length[moved]).sum(dtype=np.float64))
