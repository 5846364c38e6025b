"""Triangle quilting in a running process: seconds, how they grow, and how well edges fit."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from statistics import median
from typing import Any

import numpy as np

from benchmarks.bunny import FACES, bunny, finer
from benchmarks.clock import best, once
from benchmarks.data import SEED
from texloom.domain.faces import Faces, usual_width
from texloom.domain.surface import texel_for_repeats
from texloom.exemplar.exemplar import Exemplar
from texloom.field.direction import DirectionField
from texloom.field.smooth import smoothest
from texloom.io.mesh import read_mesh
from texloom.io.stack import read_exemplar
from texloom.kernels import launch
from texloom.mesh.mesh import Mesh
from texloom.output.blending import edge_errors
from texloom.search.textons import Textons, learn_textons
from texloom.synthesis.quilting import Quilted, Quilting
from texloom.systems import texton

TEXTONS = {64: 60, 128: 100, 200: 160, 256: 200}  # by texels a side of the sample, as published
PUBLISHED = {64: "< 1", 128: "2", 200: "4", 256: "7"}  # seconds on an Athlon at 1.3 GHz (table 2)
SAMPLES = ("text-newsprint-256", "tiles-azulejo-256", "sand-ripples-256")
REPEATS = 3.0  # sample widths across the longest side of a mesh
GROWING = ((8192, 0), (8192, 1), (8192, 2), (8192, 3), (16384, 3))  # faces, and how often each is cut into four
_SLOW = 150_000  # faces: of more, the published parameters take longer than all the rest of the page
PAIRS = (
    ("weave-wood-basket-192", "bunny"),
    ("leaves-ivy-384", "head-max-planck-5k.obj"),
    ("beans-192", "spot-3k.obj"),
    ("stones-flagstone-192", "double-torus-5k.obj"),
    ("mud-cracked-400", "fandisk-6k.obj"),
)


@dataclass(frozen=True, eq=False)
class Scene:
    """A sample's textons, with one orientation and with all, and a mesh as single faces and in patches."""

    one: Textons
    every: Textons
    alone: Faces
    patches: Faces

    @classmethod
    def of(cls, sample: Exemplar, mesh: Mesh, field: DirectionField, *, count: int | None = None) -> "Scene":
        """The sample's shorter side lies ``REPEATS`` times along the mesh."""
        side = min(sample.shape)
        texel = texel_for_repeats(mesh, REPEATS, side)
        return cls(
            one=learn_textons(sample, count=count, orientations=1, seed=SEED),
            every=learn_textons(sample, count=count, seed=SEED),
            alone=Faces.build(mesh, field, texel=texel),
            patches=Faces.build(mesh, field, texel=texel, width=usual_width(sample.shape)),
        )

    def paper(self) -> Quilted:
        """As published: any face on the front is next, textons of one orientation alone decide."""
        return texton.quilting().run(self.one, self.alone, seed=SEED)

    def grown(self) -> Quilted:
        """Ours on single faces, grown once."""
        return Quilting(rounds=0).run(self.every, self.alone, seed=SEED)

    def chosen_anew(self, rounds: int = 2) -> Quilted:
        """The same and rounds."""
        return Quilting(rounds=rounds).run(self.every, self.alone, seed=SEED)

    def usual(self) -> Quilted:
        """The default: patches of faces, and rounds."""
        return Quilting().run(self.every, self.patches, seed=SEED)


def scale_of(mesh: Mesh) -> float:
    """Eq. 1: the mean longest side of a face over the texture's shortest side."""
    longest = mesh.edge_lengths[mesh.halfedge_edges].reshape(-1, 3).max(axis=1)
    return float(longest.mean() * REPEATS / np.ptp(mesh.vertices, axis=0).max())


def synthesis(data: Path) -> list[dict[str, Any]]:
    """Table 2: one row a sample size, medians over the samples."""
    mesh = bunny(data)
    field = smoothest(mesh, 1)
    return [_synthesis_row(data, side, mesh, field) for side in TEXTONS]


def _synthesis_row(data: Path, side: int, mesh: Mesh, field: DirectionField) -> dict[str, Any]:
    scenes = [Scene.of(_crop(data, name, side), mesh, field, count=TEXTONS[side]) for name in SAMPLES]
    build = [
        best(lambda s=s: Faces.build(mesh, field, texel=s.patches.texel, width=usual_width((side, side))), 2)[0]
        for s in scenes
    ]
    row: dict[str, Any] = {"sample": f"{side}²", "textons": TEXTONS[side], "published s": PUBLISHED[side]}
    for name, work in (
        ("as published ms", Scene.paper),
        ("single faces, grown ms", Scene.grown),
        ("and 2 rounds ms", Scene.chosen_anew),
        ("default ms", Scene.usual),
    ):
        row[name] = round(1000 * median(best(lambda s=s, work=work: work(s), 2)[0] for s in scenes), 1)
    row |= {"patches ms": round(1000 * median(build), 1), "patches": scenes[0].patches.count}
    print(f"  {row}", flush=True)
    return row


def growth(data: Path) -> list[dict[str, Any]]:
    """Meshes of more and more faces, each face as large in texels: one row a mesh."""
    sample = _crop(data, SAMPLES[0], 128)
    every = learn_textons(sample, count=TEXTONS[128], seed=SEED)
    one = learn_textons(sample, count=TEXTONS[128], orientations=1, seed=SEED)
    return [_growth_row(finer(data, *cut), every, one) for cut in GROWING]


def _growth_row(mesh: Mesh, every: Textons, one: Textons) -> dict[str, Any]:
    count = len(mesh.faces)
    texel = texel_for_repeats(mesh, REPEATS * (count / FACES) ** 0.5, 128)
    field_seconds, field = once(lambda: smoothest(mesh, 1))
    build = {"mesh": mesh, "field": field, "texel": texel}
    laying, patches = once(lambda: Faces.build(**build, width=usual_width((128, 128))))
    usual, _ = _few(lambda: Quilting().run(every, patches, seed=SEED), count)
    published = None
    if count <= _SLOW:
        alone = Faces.build(**build)
        published = _few(lambda: texton.quilting().run(one, alone, seed=SEED), count)[0]
    row = {
        "faces": count,
        "field s": round(field_seconds, 3),
        "patches s": round(laying, 3),
        "default s": round(usual, 3),
    }
    row |= {"default µs a face": round(1e6 * usual / count, 2)}
    row |= {
        "as published s": published and round(published, 3),
        "as published µs a face": published and round(1e6 * published / count, 2),
    }
    print(f"  {row}", flush=True)
    return row


def _few(work: Callable[[], Any], faces: int) -> tuple[float, Any]:
    """The best of a few runs where they are short."""
    return best(work, 2) if faces < 100_000 else once(work)


def edges(data: Path) -> list[dict[str, Any]]:
    """Mean edge error, of 255, of five pairs: one row a pair."""
    rows = []
    for sample, name in PAIRS:
        mesh = bunny(data) if name == "bunny" else read_mesh(data / "meshes" / name).mesh
        scene = Scene.of(read_exemplar(data / "exemplars" / f"{sample}.png"), mesh, smoothest(mesh, 1))
        row: dict[str, Any] = {"sample": sample, "mesh": name.removesuffix(".obj"), "faces": len(mesh.faces)}
        spent, errors, borders = {}, {}, 0.0
        for what, work in (
            ("as published", Scene.paper),
            ("single faces", Scene.grown),
            ("5 rounds", lambda scene: scene.chosen_anew(5)),
            ("default", Scene.usual),
        ):
            spent[what], quilted = once(lambda w=work, s=scene: w(s))
            found = edge_errors(quilted.faces.mesh, quilted.coordinates, scene.every.image)
            errors[what] = float(found.mean.mean(dtype=np.float64))
            patch = quilted.faces.patch
            border = patch[found.halfedge // 3] != patch[mesh.twins[found.halfedge] // 3]
            borders = float(found.mean[border].mean(dtype=np.float64))
        row |= {what: round(error, 2) for what, error in errors.items()}
        row |= {"default, borders only": round(borders, 2)}
        row |= {
            "5 rounds below, %": _below(errors["5 rounds"], errors),
            "default below, %": _below(errors["default"], errors),
        }
        row |= {f"{what} ms": round(1000 * seconds, 1) for what, seconds in spent.items()}
        print(f"  {row}", flush=True)
        rows.append(row)
    return rows


def threads(data: Path) -> list[dict[str, Any]]:
    """The default and the paper's parameters on one thread and on two: one row a sample size."""
    mesh, before = bunny(data), launch.thread_count()
    field = smoothest(mesh, 1)
    rows = []
    for side in TEXTONS:
        scene = Scene.of(_crop(data, SAMPLES[0], side), mesh, field, count=TEXTONS[side])
        row: dict[str, Any] = {"sample": f"{side}²"}
        for name, work in (("as published", scene.paper), ("default", scene.usual)):
            for count in (1, 2):
                launch.use(threads=count)
                row[f"{name}, {count} ms"] = round(1000 * best(work, 3)[0], 1)
        launch.use(threads=before)
        print(f"  {row}", flush=True)
        rows.append(row)
    return rows


def _below(error: float, errors: dict[str, float]) -> float:
    """By how many per cent an error is below the paper's."""
    return round(100 * (1 - error / errors["as published"]), 1)


def _crop(data: Path, name: str, side: int) -> Exemplar:
    return read_exemplar(data / "exemplars" / f"{name}.png").crop(slice(0, side), slice(0, side))
