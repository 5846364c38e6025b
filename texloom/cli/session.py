"""One command's dealings with the terminal: progress on stderr, times, files written, the report at the end."""

import json
import math
import sys
import threading
import time
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from texloom.cli.options import DEVICES, choose
from texloom.errors import ParameterError

_MENDS = 6  # told in words
_written: list[Path] = []


def written() -> str:
    """What an interrupted command leaves behind, in words."""
    return f"after writing {', '.join(map(str, _written))}" if _written else "nothing written"


class Session:
    """Used as a context: the progress bar lives inside it, and nothing is printed on stdout before ``finish``.

    with Session(device="cpu", threads=None, as_json=False) as session:
        with session.stage("read the sample"):
            ...
        result = synthesize(..., report=session.report)
        session.finish({...})
    """

    def __init__(self, *, device: str = "cpu", threads: int | None = None, as_json: bool = False) -> None:
        self._as_json = as_json
        self._bar: Any = None
        self._task: Any = None
        self._facts: Mapping[str, Any] = {}
        self._text: str | None = None
        self._started = time.perf_counter()
        self.seconds: dict[str, float] = {}
        self._lock = threading.Lock()
        _written.clear()
        _choose_machine(device, threads)

    def __enter__(self) -> "Session":
        if sys.stderr.isatty():
            from rich.console import Console
            from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn

            columns = TextColumn("{task.description}"), BarColumn(), TextColumn("{task.percentage:>3.0f}%")
            self._bar = Progress(*columns, TimeElapsedColumn(), console=Console(stderr=True), transient=True)
            self._task = self._bar.add_task("", total=1.0)
            self._bar.start()
        return self

    def __exit__(self, failure: type | None, *_: object) -> None:
        if self._bar is not None:
            self._bar.stop()
        if failure is None:
            self._print()

    def report(self, stage: str, done: float) -> None:
        """The library's progress callback."""
        if self._bar is not None:
            self._bar.update(self._task, description=stage, completed=done)

    @contextmanager
    def stage(self, name: str) -> Iterator[None]:
        """Time a stage under this name, and show it."""
        self.report(name, 0.0)
        started = time.perf_counter()
        yield
        self.add({name: time.perf_counter() - started})

    def add(self, seconds: Mapping[str, float]) -> None:
        """Stages that the library has timed itself; of work side by side they add up to more than has passed."""
        with self._lock:
            for name, value in seconds.items():
                self.seconds[name] = self.seconds.get(name, 0.0) + value

    def wrote(self, paths: Path | Iterable[Path]) -> None:
        """Remember files that now exist."""
        _written.extend([paths] if isinstance(paths, Path) else paths)

    def finish(self, facts: Mapping[str, Any], *, text: str | None = None) -> None:
        """What the command found, printed when the session ends well: as JSON, or as ``text`` (None: aligned lines)."""
        self._facts, self._text = facts, text

    def _print(self) -> None:
        seconds = {name: round(value, 3) for name, value in self.seconds.items()}
        seconds["total"] = round(time.perf_counter() - self._started, 3)
        facts = {**self._facts, "seconds": seconds, "files": [str(path) for path in _written]}
        if self._as_json:
            print(json.dumps(_plain(facts), allow_nan=False))
        else:
            print(in_words(facts) if self._text is None else self._text)


def in_words(facts: Mapping[str, Any]) -> str:
    """Facts as aligned lines, those of a list or table below one another; empty ones left out."""
    told = {name: _words(name, value) for name, value in facts.items() if value not in (None, [], {}, (), "")}
    width = max((len(name) for name in told), default=0)
    pad = "\n" + " " * (width + 2)
    return "\n".join(f"{name:<{width}}  {text.replace(chr(10), pad)}" for name, text in told.items())


def _words(name: str, value: Any) -> str:
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, float):
        return f"{value:.4g}"
    if name == "energy":
        return f"{value[0]:.4g} to {value[-1]:.4g} in {len(value)} passes"
    if isinstance(value, Mapping):
        between = "\n" if any(isinstance(part, Mapping) for part in value.values()) else ", "
        return between.join(f"{key} {_words(key, part)}" for key, part in value.items())
    if isinstance(value, (list, tuple)):
        if name == "mends" and len(value) > _MENDS:
            value = [*value[:_MENDS], f"and {len(value) - _MENDS} more: --json tells all"]
        between = (
            "\n"
            if name in ("files", "mends", "learnt for")
            else {"size": "×", "sample": "×", "atlas": "×", "range": " to "}.get(name, ", ")
        )
        return between.join(_words("", part) for part in value)
    return str(value)


def _plain(value: Any) -> Any:
    """As JSON has it: NumPy numbers as numbers, paths as text, NaN and infinities as null."""
    if isinstance(value, Mapping):
        return {str(key): _plain(part) for key, part in value.items()}
    if isinstance(value, (list, tuple)):
        return [_plain(part) for part in value]
    if hasattr(value, "tolist"):
        return _plain(value.tolist())
    if isinstance(value, float) and not math.isfinite(value):
        return None
    return value if value is None or isinstance(value, (bool, int, float, str)) else str(value)


def _choose_machine(device: str, threads: int | None) -> None:
    choose("device", device, DEVICES)
    if device == "cpu" and threads is None:
        return  # the launcher's own defaults: do not import it yet
    from texloom.kernels import launch

    launch.use(device=device, threads=threads)
    if device == "cuda" and not launch.has_cuda():
        raise ParameterError("--device cuda: no CUDA device was found: use --device cpu")
