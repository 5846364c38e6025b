"""Pages of several parts: some are measured anew, the others stay on the page as they are."""

import argparse
import json
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Any

from benchmarks import report
from benchmarks.data import DATA


def anew(
    name: str, parts: Sequence[str], chosen: Sequence[str], measure: Callable[[str], Any]
) -> Iterator[dict[str, Any]]:
    """The page's numbers in the order of ``parts``, after each of the chosen is measured; the rest from its file."""
    path = report.RESULTS / f"{name}.json"
    numbers = json.loads(path.read_text(encoding="utf-8")) if path.is_file() else {}
    for part in chosen:
        print(f"benchmarks: {name}, {part}", flush=True)
        numbers[part] = measure(part)
        yield {known: numbers[known] for known in parts if known in numbers}


def rows(measured: Sequence[dict[str, Any]]) -> str:
    """A table of rows by column."""
    return report.table([key.strip() for key in measured[0]], [list(row.values()) for row in measured])


def command(name: str, parts: Sequence[str], doc: str | None, main: Callable[[Path, tuple[str, ...]], None]) -> None:
    """``python -m benchmarks.NAME PART...``"""
    parser = argparse.ArgumentParser(prog=f"python -m benchmarks.{name}", description=doc)
    parser.add_argument("part", nargs="*", choices=[*parts, []], help="all by default")
    parser.add_argument("--data", type=Path, default=DATA, help="folder of exemplars, meshes and sketches")
    given = parser.parse_args()
    main(given.data, tuple(given.part) or tuple(parts))
