"""Results as a page to read (Markdown) and as numbers (JSON), in ``benchmarks/results``."""

import json
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any

from benchmarks import machine

RESULTS = Path(__file__).parent / "results"


def table(header: Sequence[str], rows: Iterable[Sequence[Any]]) -> str:
    """A Markdown table; numbers are right-aligned, with three digits that matter."""
    lines = ["| " + " | ".join(header) + " |", "|" + "|".join([" --- "] + [" ---: "] * (len(header) - 1)) + "|"]
    lines += ["| " + " | ".join(_cell(value) for value in row) + " |" for row in rows]
    return "\n".join(lines)


def write(name: str, *, title: str, sections: Sequence[str], numbers: dict[str, Any]) -> None:
    """``NAME.md`` and ``NAME.json``, with the machine they were measured on, both whole or not at all."""
    RESULTS.mkdir(exist_ok=True)
    described = machine.describe()
    footer = "Machine: " + ", ".join(f"{key} {value}" for key, value in described.items()) + "."
    page = "\n\n".join([f"# {title}", *sections, footer]) + "\n"
    _replace(RESULTS / f"{name}.md", page)
    _replace(RESULTS / f"{name}.json", json.dumps({"machine": described, **numbers}, indent=1) + "\n")
    print(page, flush=True)


def _replace(path: Path, text: str) -> None:
    beside = path.with_suffix(path.suffix + ".part")
    beside.write_text(text, encoding="utf-8")
    beside.replace(path)


def _cell(value: Any) -> str:
    if value is None:
        return "–"
    if isinstance(value, float):
        return f"{value:.0f}" if abs(value) >= 100 else f"{value:.3g}"
    return str(value)
