"""What the numbers were measured on, without names of hosts or folders."""

import importlib.metadata
import os
import platform
from pathlib import Path

_PACKAGES = ("texloom", "numpy", "scipy", "warp-lang", "pillow", "gmic", "resynthesizer", "pypatchmatch")


def describe() -> dict[str, str]:
    """Processor, cores, memory, system, Python and library versions."""
    return {
        "processor": _processor(),
        "cores": str(len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count()),
        "memory": _memory(),
        "system": f"{platform.system()} {platform.machine()}",
        "python": platform.python_version(),
        **{package: version for package in _PACKAGES if (version := _version(package))},
    }


def load() -> float:
    """Mean number of running processes over the last minute: above the number of cores, times are too long."""
    return os.getloadavg()[0] if hasattr(os, "getloadavg") else float("nan")


def _processor() -> str:
    listing = Path("/proc/cpuinfo")
    if listing.is_file():
        for line in listing.read_text(encoding="utf-8").splitlines():
            if line.startswith("model name"):
                return line.partition(":")[2].strip()
    return platform.processor() or platform.machine()


def _memory() -> str:
    listing = Path("/proc/meminfo")
    if not listing.is_file():
        return "unknown"
    kilobytes = int(listing.read_text(encoding="utf-8").split("MemTotal:")[1].split()[0])
    return f"{kilobytes / 2**20:.0f} GB"


def _version(package: str) -> str | None:
    try:
        return importlib.metadata.version(package)
    except importlib.metadata.PackageNotFoundError:
        return None
