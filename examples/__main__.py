"""Draw the gallery: every ``examples/NN_topic/plot_*.py``, or those whose path holds one of the words given."""

import importlib.util
import sys
import time
from pathlib import Path
from types import ModuleType

from PIL import Image

HERE = Path(__file__).parent
GALLERY = HERE.parent / "docs" / "gallery"
_QUALITY = 88  # of JPEG


def examples() -> list[Path]:
    """Every example, in the order of the gallery."""
    return sorted(HERE.glob("*/plot_*.py"))


def load(path: Path) -> ModuleType:
    """An example as a module; its folder's name begins with a number, so it cannot be imported by name."""
    spec = importlib.util.spec_from_file_location(path.stem, path)
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def main(words: list[str]) -> None:
    """Draw the pictures and write them to ``docs/gallery``."""
    GALLERY.mkdir(parents=True, exist_ok=True)
    for path in examples():
        if words and not any(word in str(path.relative_to(HERE)) for word in words):
            continue
        start = time.perf_counter()
        target = GALLERY / f"{path.stem.removeprefix('plot_')}.jpg"
        Image.fromarray(load(path).picture()).save(target, quality=_QUALITY, optimize=True)
        seconds, size = time.perf_counter() - start, target.stat().st_size // 1024
        print(f"{path.relative_to(HERE)}: {target.relative_to(HERE.parent)}, {size} KB, {seconds:.1f} s", flush=True)


if __name__ == "__main__":
    main(sys.argv[1:])
