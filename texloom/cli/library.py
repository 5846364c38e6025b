"""What files of textons say of themselves, one or a folder of them."""

from pathlib import Path
from typing import TYPE_CHECKING, Any

from texloom.cli.options import IMAGE_SUFFIXES
from texloom.errors import FileError

if TYPE_CHECKING:
    from texloom.output.textons_file import TextonsEntry

SUFFIX = ".textons"
_COLUMNS = ("name", "sample", "maps", "textons", "features", "orientations", "kB")


def facts_of(entry: "TextonsEntry") -> dict[str, Any]:
    """What a file of textons holds."""
    settings = entry.settings
    return {
        "kind": "textons",
        "name": entry.path.name,
        "sample": entry.size,
        "maps": {name: {"bits": bits} for name, bits in entry.maps.items()},
        "masked": entry.masked,
        "textons": entry.textons,
        "features": settings.features,
        "window": settings.width if settings.features == "window" else None,
        "orientations": settings.orientations,
        "seed": settings.seed,
        "passes": entry.passes,
        "kept": entry.kept,
        "bytes": entry.bytes,
        "made": dict(entry.made),
    }


def textons_in(folder: Path) -> list[Path]:
    """The files of textons in a folder, by name; none where its images are a stack of maps."""
    from texloom.io.names import role_of

    files = [file for file in sorted(folder.iterdir()) if file.is_file()]
    found = [file for file in files if file.suffix.lower() == SUFFIX]
    stack = any(role_of(file) for file in files if file.suffix.lower() in IMAGE_SUFFIXES)
    return [] if stack else found


def list_library(files: list[Path]) -> tuple[dict[str, Any], str]:
    """The facts of each file, and the same as a table; of a damaged one what is wrong with it."""
    from texloom.output.textons_file import read_entry

    listed: list[dict[str, Any]] = []
    for file in files:
        try:
            listed.append(facts_of(read_entry(file)))
        except FileError as error:
            listed.append({"kind": "textons", "name": file.name, "problem": str(error)})
    return {"kind": "library", "library": listed}, _as_table(listed)


def _as_table(listed: list[dict[str, Any]]) -> str:
    """One line a file; names to the left, numbers to the right."""
    lines = [list(_COLUMNS), *(_line(facts) for facts in listed if "problem" not in facts)]
    width = [max(len(line[place]) for line in lines) for place in range(len(_COLUMNS))]
    numbers = ("textons", "orientations", "kB")
    table = [
        "  ".join(
            text.rjust(wide) if name in numbers else text.ljust(wide)
            for name, text, wide in zip(_COLUMNS, line, width, strict=True)
        )
        for line in lines
    ]
    return "\n".join([*table, *(facts["problem"] for facts in listed if "problem" in facts)])


def _line(facts: dict[str, Any]) -> list[str]:
    features = f"window {facts['window']}" if facts["window"] else facts["features"]
    return [
        facts["name"],
        "×".join(map(str, facts["sample"])),
        ", ".join(facts["maps"]),
        str(facts["textons"]),
        features,
        str(facts["orientations"]),
        str(-(-facts["bytes"] // 1000)),
    ]
