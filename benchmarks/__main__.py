"""Run the benchmarks: all of them, or those named on the command line."""

import argparse
import importlib
import os
from pathlib import Path

from benchmarks.data import DATA

PAGES = ("picture", "refine", "fill", "speed", "table1", "textons", "sweep", "sketch")


def main() -> None:
    parser = argparse.ArgumentParser(prog="python -m benchmarks", description=__doc__)
    parser.add_argument("page", nargs="*", choices=[*PAGES, []], help="one or more of the pages; all by default")
    parser.add_argument("--data", type=Path, default=DATA, help="folder of exemplars, stacks and meshes")
    arguments = parser.parse_args()
    if not arguments.data.is_dir():
        print(f"benchmarks: no data folder at {os.path.relpath(arguments.data)}: give --data or set TEXLOOM_DATA")
        return
    for page in arguments.page or PAGES:
        print(f"benchmarks: {page}", flush=True)
        importlib.import_module(f"benchmarks.{page}").main(arguments.data)


if __name__ == "__main__":
    main()
