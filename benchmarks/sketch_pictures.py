"""What becomes of sketches: detail kept, lines where they were drawn, an end for every file."""

from functools import partial
from pathlib import Path

import numpy as np
from jaxtyping import Bool, Float64
from scipy.ndimage import distance_transform_edt, gaussian_filter, map_coordinates

from benchmarks.clock import once
from benchmarks.data import SEED
from benchmarks.sketch_scenes import PAIRS, Picture, Rows, design_of, load_sample, load_sketch, mesh_of, shown
from texloom.errors import TexloomError
from texloom.metrics.score import score
from texloom.output.image import encoded_picture
from texloom.sketch.design import Design
from texloom.sketch.filling.maps import FeatureMaps
from texloom.sketch.filling.pixels import PixelSynthesis
from texloom.sketch.filling.warp import Initialization
from texloom.sketch.reading.read import read_sketch
from texloom.sketch.sample import SketchSample
from texloom.systems import sketch as published

FINE = 1.5  # texels: what a blur of that takes away is detail
_LINE = 0.07  # of a cell: the blur at which lines stand out,
_FINEST = 0.8  # texels, at least
_ON_EDGE = 0.5  # texels
_BORDER = 4  # texels of the texture's border left out
_FILES_WITH = "scales-green-cells-192"


def detail(data: Path) -> Rows:
    """High-frequency energy of textures over that of the sample, orientation features on and off."""
    rows: Rows = []
    for name, drawing in PAIRS.items():
        sample, sketch = load_sample(data, name), load_sketch(data, drawing)
        ours = design_of(sketch, sample)
        paper = partial(published.design, sketch, sample, mesh_of(sketch, sample), inside=sample.inside, seed=SEED)
        designs = {
            "laid in only": ours.changed(pixels=PixelSynthesis(passes=0)),
            "on": ours,
            "off": ours.changed(pixels=PixelSynthesis(turned=False)),
            "the paper's, on": paper(turned=True),
            "the paper's, off": paper(turned=False),
        }
        whole = energy(encoded_picture(sample.exemplar.lead.image))
        for read, copied in {"between texels": False, "copied": True}.items():
            rows.append({"sample": name, "sketch": drawing, "read": read})
            for key, design in designs.items():
                rows[-1][key] = round(energy(shown(design, copied=copied)) / whole, 3)
            print(f"  {rows[-1]}", flush=True)
    return rows


def energy(picture: Picture) -> float:
    """Mean squared difference to the blurred picture."""
    image = picture.astype(np.float64) / 255
    return float(((image - gaussian_filter(image, (FINE, FINE, 0), mode="nearest")) ** 2).mean())


def shapes(data: Path) -> Rows:
    """Texels from edges of the texture mesh to the strongest lines of the texture."""
    rows: Rows = []
    for name, drawing in PAIRS.items():
        sample, sketch = load_sample(data, name), load_sketch(data, drawing)
        ours = design_of(sketch, sample)
        paper = published.design(sketch, sample, ours.mesh, inside=sample.inside, seed=SEED)
        dark = _is_dark(sample)
        its = encoded_picture(sample.exemplar.lead.image)
        rows.append({"sample": name, "sketch": drawing, "lines": "dark" if dark else "bright"})
        rows[-1] |= {"cell": round(sample.cell_size, 1), "the sample's own": _apart(its, sample.maps, sample, dark)}
        laid = ours.changed(pixels=PixelSynthesis(passes=0))
        for key, design in {"laid in only": laid, "ours": ours, "the paper's": paper}.items():
            rows[-1][key] = _apart(shown(design), design.maps, sample, dark)
        rows[-1]["by chance"] = _apart(shown(ours), _elsewhere(ours).maps, sample, dark)
        print(f"  {rows[-1]}", flush=True)
    return rows


def steps(data: Path) -> Rows:
    """From the paper's method to ours, step by step: means over the pairs."""
    kept: dict[str, list[list[float]]] = {}
    for name, drawing in PAIRS.items():
        sample, sketch = load_sample(data, name), load_sketch(data, drawing)
        its, dark = encoded_picture(sample.exemplar.lead.image), _is_dark(sample)
        for step, design in _from_the_papers(design_of(sketch, sample)).items():
            picture = shown(design)
            scores = score(its, picture)
            found = [energy(picture) / energy(its), _apart(picture, design.maps, sample, dark)]
            kept.setdefault(step, []).append(found + [scores.coherence, scores.completeness, scores.swd])
        print(f"  {name}", flush=True)
    columns = ("detail", "lines", "fit", "fit back", "swd")
    means = {step: np.mean(found, axis=0).round(2).tolist() for step, found in kept.items()}
    return [{"step": step} | dict(zip(columns, found, strict=True)) for step, found in means.items()]


def _from_the_papers(ours: Design) -> dict[str, Design]:
    """Designs with one more of our choices each, then with one of them taken back."""
    sample = ours.sample
    paper = published.design(ours.sketch, sample, ours.mesh, inside=sample.inside, seed=SEED)
    alike = paper.changed(deal=ours.deal)
    carried = alike.changed(initialization=Initialization(inside=sample.inside))
    return {
        "the paper's first image": paper.changed(pixels=PixelSynthesis(passes=0)),
        "the paper: four passes": paper,
        "+ cells much alike": alike,
        "+ lines carried": carried,
        "+ one pass only: the default": ours,
        "the same, neighbourhoods upright": ours.changed(pixels=PixelSynthesis(turned=False)),
        "no pass": ours.changed(pixels=PixelSynthesis(passes=0)),
        "all cells by radial": ours.changed(initialization=Initialization(inside="radial")),
        "all cells by scale": ours.changed(initialization=Initialization(inside="scale")),
    }


def _elsewhere(design: Design) -> Design:
    """The same with the cells of another draw, and moved on by half a cell."""
    other = design.changed(seed=SEED + 1)
    half = design.sample.cell_size / 2
    other.__dict__["graph"] = other.graph.moved(other.graph.vertices + half)
    return other


def _apart(picture: Picture, maps: FeatureMaps, sample: SketchSample, dark: bool) -> float:
    """Mean distance from texels on edges to the nearest of as many texels on the ridges of strongest lines."""
    edges = maps.away <= _ON_EDGE
    strength = _strength(picture, sample, dark)[0]
    ridge = _ridges(picture, sample, dark)
    most = np.sort(strength[ridge])[::-1][: np.count_nonzero(edges)]
    away = distance_transform_edt(~(ridge & (strength >= most[-1])))
    inner = (slice(_BORDER, -_BORDER),) * 2
    return round(float(np.asarray(away)[inner][edges[inner]].mean()), 2)


def _is_dark(sample: SketchSample) -> bool:
    """Whether lines between the sample's cells are darker than what is beside them."""
    picture = encoded_picture(sample.exemplar.lead.image)
    edges = sample.maps.away <= _ON_EDGE
    return bool(_strength(picture, sample, True)[0][edges].mean() > _strength(picture, sample, False)[0][edges].mean())


def _strength(
    picture: Picture, sample: SketchSample, dark: bool
) -> tuple[Float64[np.ndarray, "row column"], Float64[np.ndarray, "row column"]]:
    """The larger principal curvature of the picture's light, and the angle across the line, from rows to columns."""
    grey = picture.astype(np.float64).mean(axis=2) * (1 if dark else -1)
    blur = max(_LINE * sample.cell_size, _FINEST)
    down, across, both = (
        np.asarray(gaussian_filter(grey, blur, order=order, mode="nearest"))  # pyright: ignore[reportArgumentType]
        for order in ((2, 0), (0, 2), (1, 1))
    )
    return (down + across) / 2 + np.hypot((down - across) / 2, both), 0.5 * np.arctan2(2 * both, down - across)


def _ridges(picture: Picture, sample: SketchSample, dark: bool) -> Bool[np.ndarray, "row column"]:
    """Where lines are strongest across themselves."""
    strength, angle = _strength(picture, sample, dark)
    across = np.stack([np.cos(angle), np.sin(angle)])
    place = np.indices(strength.shape)
    sides = [map_coordinates(strength, place + sign * across, order=1, mode="nearest") for sign in (-1, 1)]
    return (strength > 0) & (strength >= sides[0]) & (strength > sides[1])


def files(data: Path) -> Rows:
    """Every sketch file to its texture, or to the line that says why not."""
    sample = load_sample(data, _FILES_WITH)
    rows: Rows = []
    for path in sorted((data / "sketches").iterdir()):
        rows.append({"file": path.name} | _ended(path, sample))
        print(f"  {rows[-1]}", flush=True)
    return rows


def _ended(path: Path, sample: SketchSample) -> dict[str, object]:
    try:
        read, (graph, mends) = once(lambda: read_sketch(path))
        design = design_of(graph, sample)
        grown = once(lambda: shown(design))[0]
    except TexloomError as error:
        return {"cells": None, "mended": None, "patch": None, "texture": None, "read": None, "ends in": str(error)}
    crop = "whole" if design.patch.cost == 0 else "mirrored" if design.patch.mirrored else "crop"
    return {
        "cells": len(graph.cells()),
        "mended": len(mends),
        "patch": crop,
        "texture": len(np.unique(design.maps.cell[design.maps.cell >= 0])),
        "read": round(read, 2),
        "ends in": f"a texture after {grown:.2f} s" + (f"; {design.patch.note}" if design.patch.note else ""),
    }
