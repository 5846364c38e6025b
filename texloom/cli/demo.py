"""``texloom demo``: everything once, from nothing."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from texloom.cli import options
from texloom.cli.session import Session

if TYPE_CHECKING:
    from texloom.domain.surface import Surface
    from texloom.exemplar.exemplar import Exemplar
    from texloom.mesh.model import Model

IMAGES = ("pebbles", "bricks")
COATS = ("scales", "knit")
_REPEATS = 2.0  # sample widths across the rabbit


def demo(
    output: Annotated[Path, typer.Option("--output", "-o", metavar="FOLDER")] = Path("demo-output"),
    size: Annotated[str, typer.Option(metavar="W[xH]", help="Texels of the images.")] = "512",
    seed: options.Seed = 0,
    device: options.Device = "cpu",
    threads: options.Threads = None,
    as_json: options.Json = False,
) -> None:
    """Draw samples and a mesh, texture images and the mesh, and say where the pictures are."""
    shape = options.parse_size(size)
    with Session(device=device, threads=threads, as_json=as_json) as session:
        with session.stage("draw"):
            from texloom.demo import SAMPLES, write_rabbit, write_sample
            from texloom.io.stack import read_exemplar

            folders = {name: output / "samples" / name for name in SAMPLES}
            for name, folder in folders.items():
                session.report(f"draw {name}", 0.0)
                write_sample(folder, name, seed=seed)
                session.wrote(folder)
            rabbit = write_rabbit(output / "rabbit.obj")
            session.wrote(rabbit)
        for name in IMAGES:
            with session.stage(f"image of {name}"):
                _grow_image(output / f"{name}-tileable", read_exemplar(folders[name]), shape, seed, session)
        with session.stage("rabbit"):
            model, surface = _sites(rabbit)
        for name in COATS:
            with session.stage(f"rabbit in {name}"):
                _grow_coat(model, surface, name, read_exemplar(folders[name]), seed, session)
        pictures = [str(output / f"rabbit-{name}.png") for name in COATS]
        made = f"{len(folders)} samples, {len(IMAGES)} tileable images and {len(COATS)} coats for a rabbit"
        text = f"{made} in {output}: look at {' and '.join(pictures)}"
        session.finish({"seed": seed, "made": made, "look at": pictures}, text=text)


def _grow_image(folder: Path, exemplar: "Exemplar", shape: tuple[int, int], seed: int, session: Session) -> None:
    """A tileable stack of maps."""
    from texloom.domain.grid import Grid
    from texloom.output.gather import gather_images
    from texloom.output.image import write_images
    from texloom.synthesis.synthesize import synthesize

    result = synthesize(exemplar, Grid(*shape, wrap=True), seed=seed, report=session.report)
    write_images(folder, gather_images(result.sources, exemplar, rows=shape[0], columns=shape[1]))
    session.wrote(folder)


def _sites(mesh: Path) -> "tuple[Model, Surface]":
    """The mesh, and sites on it for upright texture from samples of the demo's size."""
    from texloom.demo.write import SIZE
    from texloom.domain.surface import Surface, texel_for_repeats
    from texloom.field.smooth import smoothest
    from texloom.io.mesh import read_mesh

    model = read_mesh(mesh)
    texel = texel_for_repeats(model.mesh, _REPEATS, SIZE)
    return model, Surface.build(model.mesh, smoothest(model.mesh, 1), texel=texel)


def _grow_coat(
    model: "Model", surface: "Surface", name: str, exemplar: "Exemplar", seed: int, session: Session
) -> None:
    """The mesh in a coat of texture, upright, and its preview."""
    from texloom.cli.bring_home import AtlasWish, Grown, bring_home, write_preview
    from texloom.synthesis.synthesize import synthesize

    mesh = model.path
    result = synthesize(exemplar, surface, seed=seed, report=session.report)
    grown = Grown(model, surface, result.sources, exemplar)
    home = bring_home(
        grown,
        mesh.with_name(f"{mesh.stem}-{name}.glb"),
        home="atlas",
        atlas=AtlasWish(),
        settings=options.settings("demo", Path(name), seed=seed),
    )
    session.wrote([*home.files, write_preview(mesh.with_name(f"{mesh.stem}-{name}.png"), grown, home.skin)])
