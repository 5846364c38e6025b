"""Visiting sites again and again: each takes the source that fits what its surroundings show."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from jaxtyping import Float32, Int32, UInt8

from texloom.arrays import Image, fours
from texloom.domain.neighbourhoods import Neighbourhoods, Stencils
from texloom.kernels.correction import find_sources, show_sources, visit_in_order
from texloom.kernels.launch import Lasting, launch
from texloom.search.window_tree import WindowTree
from texloom.synthesis.canvas import Canvas

_CANDIDATES = 12  # distinct continuations compared at most; near a border there are two to eight

_FLOATS, _INTEGERS = np.zeros((0, 1, 4), np.float32), np.zeros((0, 2), np.int32)
NO_TREE = {name: _FLOATS for name in ("mean", "points", "low", "high")}
NO_TREE |= {name: _INTEGERS[:, 0].copy() for name in ("index", "first", "last")}
NO_TREE |= {"axes": _FLOATS[:, None].copy(), "centre": _INTEGERS}


@dataclass(frozen=True, eq=False)
class Guide:
    """Where sources come from: continuations of what the neighbours show, texels alike, and a tree of all windows."""

    image: Image  # channels in fours
    usable: UInt8[np.ndarray, "row column"]  # the kind of site a neighbourhood centred there may serve; 0: none
    similar: Int32[np.ndarray, "row column k 2"]
    suggesting: int = 1  # of the near sites, the middle one first, those whose alike texels are tried
    tree: WindowTree | None = None
    nearest: int = 1  # windows that the tree is asked for
    candidates: int = _CANDIDATES
    axis: Float32[np.ndarray, "row column"] | None = None  # the angle of each texel's own axes; None: all 0

    @property
    def as_exemplar(self) -> dict[str, object]:
        """For the kernels."""
        told: dict[str, object] = {"image": fours(self.image), "usable": self.usable}
        if self.axis is not None:
            told["axis"] = self.axis
        return told | {"similar": self.similar, "suggesting": self.suggesting}


class Visits:
    """Neighbourhoods on a canvas, and when each was visited last: none is in vain while nothing changed around it.

    ``samples`` of the stencils are compared (None: all); ``kind`` is that of every site (None: all are 1).
    """

    def __init__(
        self,
        guide: Guide,
        canvas: Canvas,
        around: Neighbourhoods,
        stencils: Stencils,
        samples: Int32[np.ndarray, "sample"] | None = None,
        kind: UInt8[np.ndarray, "site"] | None = None,
    ) -> None:
        everything = np.arange(stencils.sites.shape[1], dtype=np.int32)
        self.guide, self.canvas, self._kind = guide, canvas, kind
        self.cost = np.zeros(len(around.sites), np.float32)  # mean squared difference at the last visit
        self._samples = everything if samples is None else samples
        self._around = Lasting(
            {
                "samples": self._samples,
                "sites": stencils.sites,
                "weights": np.ones((1, 1, 1), np.float32) if stencils.weights is None else stencils.weights,
                "offset": stencils.offset,
                "near": around.sites,
                "near_offset": around.offset,
                "turned": np.zeros((1, 1), np.float32) if around.turn is None else around.turn,
            }
        )
        self._exemplar = Lasting(guide.as_exemplar)
        self._visited = np.zeros(len(around.sites), np.int32)
        self._changed = np.zeros(len(canvas.label), np.int32)
        self._now = 0
        self._room: Lasting | None = None

    @property
    def mean_cost(self) -> float:
        """Over all neighbourhoods."""
        return float(self.cost.mean(dtype=np.float64)) if len(self.cost) else 0.0

    def at_once(self, chosen: Int32[np.ndarray, "chosen"]) -> None:
        """All chosen neighbourhoods, from what the canvas shows now."""
        self._now += 1
        desk = self._desk(len(chosen))
        launch(
            find_sources,
            len(chosen),
            inputs=[chosen, self._around, self._canvas, self._visited, self._exemplar, self._tree],
            outputs=[desk, self.cost],
            grain=64,
        )
        launch(
            show_sources,
            len(chosen),
            inputs=[chosen, self._now, self._around, self._exemplar, desk],
            outputs=[self._visited, self._canvas],
            grain=4096,
        )

    def in_order(self, chosen: Int32[np.ndarray, "chosen"]) -> None:
        """One after the other, each seeing what those before it show."""
        self._now += 1
        launch(
            visit_in_order,
            1,
            inputs=[chosen, self._now, self._around, self._exemplar, self._tree, self._desk(1)],
            outputs=[self._visited, self._canvas, self.cost],
        )

    @cached_property
    def _canvas(self) -> Lasting:
        canvas, kind = self.canvas, {} if self._kind is None else {"kind": self._kind}
        shown = {"position": canvas.position, "turn": canvas.turn, "colour": fours(canvas.colour)}
        return Lasting(kind | shown | {"label": canvas.label, "changed": self._changed})

    @cached_property
    def _tree(self) -> Lasting:
        """Of no windows, where none is asked."""
        return Lasting(NO_TREE if self.guide.tree is None else self.guide.tree.arrays)

    def _desk(self, rows: int) -> Lasting:
        """Room for so many neighbourhoods at work, or more."""
        if self._room is None or len(self._room["found"]) < rows:
            tree, samples, channels = self.guide.tree, len(self._samples), self.guide.image.shape[2]
            self._room = Lasting(
                {
                    "seen": fours(np.empty((rows, samples, channels), np.float32)),
                    "known": np.empty((rows, samples), np.float32),
                    "query": fours(np.empty((rows, 4 if tree is None else tree.axes.shape[2]), np.float32)),
                    "nearest": np.empty((rows, self.guide.nearest), np.int32),
                    "distance": np.empty((rows, self.guide.nearest), np.float32),
                    "tried": np.empty((rows, self.guide.candidates, 3), np.float32),
                    "found": np.empty((rows, 3), np.float32),
                }
            )
        return self._room
