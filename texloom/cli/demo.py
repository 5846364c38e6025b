"""``texloom demo``: everything once, from nothing."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from texloom.cli import options
from texloom.cli.session import Session
from texloom.errors import FileError

if TYPE_CHECKING:
    from texloom.exemplar.exemplar import Exemplar

IMAGES = ("pebbles", "bricks")
COATS = ("scales", "knit")
_REPEATS = 2.5  # sample widths across the rabbit


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
    try:
        output.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise FileError(f"{output} cannot be made ({error.strerror}): choose another folder with -o") from error

    with Session(device=device, threads=threads, as_json=as_json) as session:
        with session.stage("draw"):
            from texloom.demo import write_rabbit, write_samples
            from texloom.io.stack import read_exemplar

            folders = write_samples(output / "samples", seed=seed)
            rabbit = write_rabbit(output / "rabbit.obj")
            session.wrote([*folders.values(), rabbit])
        for name in IMAGES:
            with session.stage(f"image of {name}"):
                _grow_image(output / f"{name}-tileable", read_exemplar(folders[name]), shape, seed, session)
        for name in COATS:
            with session.stage(f"rabbit in {name}"):
                _grow_coat(rabbit, name, read_exemplar(folders[name]), seed, session)
        session.finish({"seed": seed, "look at": str(output / f"rabbit-{COATS[0]}.png")})


def _grow_image(folder: Path, exemplar: "Exemplar", shape: tuple[int, int], seed: int, session: Session) -> None:
    """A tileable stack of maps."""
    from texloom.domain.grid import Grid
    from texloom.output.gather import gather_images
    from texloom.output.image import write_images
    from texloom.synthesis.synthesize import synthesize

    result = synthesize(exemplar, Grid(*shape, wrap=True), seed=seed, report=session.report)
    write_images(folder, gather_images(result.sources, exemplar, rows=shape[0], columns=shape[1]))
    session.wrote(folder)


def _grow_coat(mesh: Path, name: str, exemplar: "Exemplar", seed: int, session: Session) -> None:
    """The mesh in a coat of texture, upright, and its preview."""
    from texloom.cli.bring_home import AtlasWish, Grown, bring_home, write_preview
    from texloom.domain.surface import Surface, texel_for_repeats
    from texloom.field.smooth import smoothest
    from texloom.io.mesh import read_mesh
    from texloom.synthesis.synthesize import synthesize

    model = read_mesh(mesh)
    texel = texel_for_repeats(model.mesh, _REPEATS, exemplar.shape[1])
    surface = Surface.build(model.mesh, smoothest(model.mesh, 1), texel=texel)
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
