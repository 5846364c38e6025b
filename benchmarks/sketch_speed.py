"""Milliseconds of the sketch method, stage by stage, on one thread and on two."""

from dataclasses import replace
from itertools import count, islice
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks import machine
from benchmarks.clock import best, once
from benchmarks.sketch_scenes import PAIRS, Rows, design_of, load_sample, load_sketch, shown
from texloom.errors import ParameterError
from texloom.kernels import launch
from texloom.sketch.design import Design

SIDES = (128, 256)
TIMED = tuple(PAIRS)[:3]
STAGES = {  # what is made anew whenever the sketch is laid out again; patch and sample are made once
    "mesh": ("tiling", "graph"),
    "cells": ("cells", "shapes"),
    "maps": ("maps",),
    "deal": ("assignment",),
    "start": ("start",),
    "pixels": ("canvas",),
}
_TIMES = 7
_MOVES = 5  # vertices, one at a time
_FAR = 0.12  # of a cell: how far each is moved


def speed(data: Path) -> Rows:
    """One row for every pair, size and number of threads."""
    rows: Rows = []
    for name in TIMED:
        sample, sketch = load_sample(data, name), load_sketch(data, PAIRS[name])
        for side in SIDES:
            for threads in (1, 2):
                launch.use(threads=threads)
                design = _prepared(design_of(sketch, sample, side))
                rows.append({"sample": name, "side": side, "threads": threads} | _timed(design))
                rows[-1]["load before"] = round(machine.load(), 1)
                print(f"  {rows[-1]}", flush=True)
    return rows


def preparation(data: Path) -> Rows:
    """What is done once: the sample's cells and maps, the sketch's file, its seamless patch."""
    launch.use(threads=2)
    rows: Rows = []
    for name in TIMED:
        seconds = {}
        seconds["cells of it"], sample = best(lambda name=name: load_sample(data, name), 1)
        seconds["read"], sketch = best(lambda name=name: load_sketch(data, PAIRS[name]), 1)
        seconds["patch"], _ = best(lambda sketch=sketch, sample=sample: _patched(design_of(sketch, sample)), 1)
        spent = {key: round(1e3 * least) for key, least in seconds.items()}
        rows.append({"sample": name, "cells of it": spent.pop("cells of it"), "sketch": PAIRS[name]} | spent)
        print(f"  {rows[-1]}", flush=True)
    return rows


def _patched(design: Design) -> Any:
    return design.patch.web, design.patch.widest


def _prepared(design: Design) -> Design:
    """With all that is made once."""
    _patched(design)
    _ = design.guide, design.sample.shapes
    return design


def _timed(design: Design) -> dict[str, float]:
    """Milliseconds of each stage, of all of them and the picture, and after a moved vertex: the least of several."""
    fresh, runs = design, list[dict[str, float]]()
    for _ in range(1 + _TIMES):
        fresh = replace(design)
        fresh.__dict__.update(patch=design.patch, guide=design.guide)
        spent = dict[str, float]()
        for stage, made in STAGES.items():
            spent[stage] = once(lambda made=made, fresh=fresh: [getattr(fresh, name) for name in made])[0]
        spent["picture"] = once(lambda fresh=fresh: shown(fresh))[0]
        runs.append(spent | {"all": sum(spent.values())})
    moves = list(islice(filter(None, (_moved(fresh, number) for number in count())), _MOVES))
    least = {stage: min(run[stage] for run in runs[1:]) for stage in runs[0]}
    return {stage: round(1e3 * seconds, 1) for stage, seconds in (least | {"moved": float(np.median(moves))}).items()}


def _moved(design: Design, number: int) -> float | None:
    """Seconds until a vertex near the middle of the texture lies elsewhere, picture included; the least of three.

    None, where so far a move would make edges cross.
    """
    graph = design.graph
    away = np.hypot(*(graph.vertices - np.array(design.mesh.size) / 2).T)
    away[graph.degree < 3] = np.inf
    vertices = graph.vertices.copy()
    vertices[np.argsort(away)[number]] += _FAR * design.sample.cell_size
    try:
        return best(lambda: shown(design.moved(vertices)), 3)[0]
    except ParameterError:
        return None
