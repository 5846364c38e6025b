"""Output files appear whole or not at all: written beside, then renamed."""

import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from texloom.errors import FileError


@contextmanager
def atomic(path: str | Path) -> Iterator[Path]:
    """A path beside ``path`` to write to; renamed to ``path`` when the block ends well, removed otherwise.

    The temporary name keeps the suffix, for writers that choose a format by it. Nest several (``ExitStack``) to write
    a folder of files that all appear or none does: they are renamed only after the last one was written.

    Raises: FileError, if the folder does not exist or cannot be written.
    """
    path = Path(path)
    if not path.parent.is_dir():
        raise FileError(f"{path}: there is no folder {path.parent}: make it first, or choose another place")
    if path.is_dir():
        raise FileError(f"{path} is a folder: give a file name inside it")
    beside = path.with_name(f".{path.stem}.{os.getpid()}.part{path.suffix}")
    try:
        yield beside
        os.replace(beside, path)
    except OSError as error:
        raise FileError(f"{path} cannot be written: {error.strerror or error}") from error
    finally:
        beside.unlink(missing_ok=True)
