"""The one place that knows threads and devices.

Warp runs a CPU launch on one thread but releases the interpreter lock, so a launch here is cut into chunks over a
thread pool; on CUDA it is a single launch. Every kernel takes ``start`` (the first index of its chunk) as its first
argument, and thread ``t`` works on item ``start + t``:

    @wp.kernel(enable_backward=False)
    def double(start: int, values: wp.array(dtype=float), doubled: wp.array(dtype=float)):
        i = start + wp.tid()
        doubled[i] = 2.0 * values[i]

    launch(double, len(values), inputs=[values], outputs=[doubled])

A kernel writes its own item of the outputs only, so the result does not depend on the number of threads. Where it
takes a ``wp.struct``, it is given a dict of the struct's fields.
"""

import os
import sys
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from typing import Any

import numpy as np
import warp as wp

_CHUNKS_PER_THREAD = 4  # enough to even out uneven items, few enough that a launch (about 30 µs) stays cheap

wp.config.log_level = wp.LOG_ERROR
wp.config.enable_backward = False


class _Machine:
    """Where launches run: device name and thread pool. Process-wide, set by ``use``."""

    device = "cpu"
    threads = min(len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1, 64)
    pool: ThreadPoolExecutor | None = None
    told = False  # that kernels are being compiled


def use(*, device: str | None = None, threads: int | None = None) -> None:
    """Choose the device (``"cpu"`` or ``"cuda"``) and the number of CPU threads for all launches of this process."""
    if device is not None:
        _Machine.device = device
    if threads is not None and threads != _Machine.threads:
        _Machine.threads = threads
        if _Machine.pool is not None:
            _Machine.pool.shutdown()
        _Machine.pool = None


def has_cuda() -> bool:
    """Whether a CUDA device can be used."""
    _initialize()
    return wp.is_cuda_available()


def thread_count() -> int:
    """Threads in use on the CPU."""
    return _Machine.threads


def parallel_map(function: Callable[[int], Any], count: int) -> list[Any]:
    """``[function(0), ..., function(count - 1)]`` over the pool, for work that releases the interpreter lock."""
    if _Machine.threads == 1 or count == 1:
        return [function(i) for i in range(count)]
    if _Machine.pool is None:
        _Machine.pool = ThreadPoolExecutor(_Machine.threads)
    return list(_Machine.pool.map(function, range(count)))


def launch(kernel: Any, count: int, *, inputs: Sequence[Any], outputs: Sequence[Any], grain: int = 32) -> None:
    """Run ``kernel`` for items ``0 .. count - 1``. Arrays are NumPy, C-contiguous, shared with the kernel on the CPU.

    ``inputs`` and ``outputs`` follow ``start`` in the kernel's order; arrays in ``outputs`` are written in place.
    ``grain`` is the fewest items worth a thread: lower it where an item takes long (a chunk costs some 50 µs).
    """
    if count == 0:
        return
    _load(kernel)
    if _Machine.device != "cpu":
        _launch_on_device(kernel, count, inputs, outputs)
        return
    arguments = _share(kernel, (*inputs, *outputs))
    chunks = 1 if _Machine.threads == 1 else min(_Machine.threads * _CHUNKS_PER_THREAD, -(-count // grain))
    bounds = np.linspace(0, count, chunks + 1).astype(int)

    def run(chunk: int) -> None:
        first, last = int(bounds[chunk]), int(bounds[chunk + 1])
        wp.launch(kernel, dim=last - first, inputs=[first, *arguments], device="cpu")

    parallel_map(run, len(bounds) - 1)


class Lasting(dict[str, Any]):
    """The fields of a struct that launch after launch is given: the same arrays, shared with the CPU once."""

    view: Any = None


class Repeated:
    """A kernel launched again and again on the same arrays, where a launch each would cost more than its work.

    ``inputs`` and ``outputs`` are shared with the kernel once; only the ``varying`` numbers between ``start`` and the
    inputs differ from run to run. An item is a thread's whole share of the work, too little for an accelerator: it
    runs on the CPU on any device.
    """

    def __init__(self, kernel: Any, varying: int, *, inputs: Sequence[Any], outputs: Sequence[Any]) -> None:
        _load(kernel)
        self._kernel, self._varying = kernel, varying
        self._arguments = _share(kernel, (*inputs, *outputs), skip=1 + varying)
        self._commands: list[Any] = []

    def run(self, count: int, *numbers: int) -> None:
        """Items ``0 .. count - 1``."""
        assert len(numbers) == self._varying, f"{self._varying} numbers precede the inputs"
        while len(self._commands) < count:
            arguments = [len(self._commands), *numbers, *self._arguments]
            command = wp.launch(self._kernel, dim=1, inputs=arguments, device="cpu", record_cmd=True)
            self._commands.append(command)

        def run(item: int) -> None:
            command = self._commands[item]
            for place, number in enumerate(numbers):
                command.set_param_at_index(1 + place, number)
            command.launch()

        parallel_map(run, count)


def _share(kernel: Any, values: Sequence[Any], device: str = "cpu", skip: int = 1) -> list[Any]:
    """Warp views of NumPy arrays, in the element type the kernel declares (vectors too); anything else as it is."""
    declared = kernel.adj.args[skip:]
    return [_view(it.type, value, it.label, device) for it, value in zip(declared, values, strict=True)]


def _view(declared: Any, value: Any, name: str, device: str) -> Any:
    """One of them."""
    if isinstance(value, np.ndarray):
        assert value.flags.c_contiguous, f"{name}: kernels take C-contiguous arrays"
        return wp.array(value, dtype=declared.dtype, copy=False, device=device)
    if not isinstance(value, Mapping):
        return value
    lasts = isinstance(value, Lasting) and device == "cpu"
    if lasts and value.view is not None:
        return value.view
    struct = declared()
    for field, part in value.items():
        setattr(struct, field, _view(declared.vars[field].type, part, f"{name}.{field}", device))
    if lasts:
        value.view = struct
    return struct


def _launch_on_device(kernel: Any, count: int, inputs: Sequence[Any], outputs: Sequence[Any]) -> None:
    """One launch on an accelerator, with the arrays copied there and the outputs copied back."""
    on_device = _share(kernel, (*inputs, *outputs), _Machine.device)
    wp.launch(kernel, dim=count, inputs=[0, *on_device], device=_Machine.device)
    for target, result in zip(outputs, on_device[len(inputs) :], strict=True):
        _copy_back(target, result)


def _copy_back(target: Any, result: Any) -> None:
    """What the device wrote into an output."""
    if isinstance(target, Mapping):
        for field, part in target.items():
            _copy_back(part, getattr(result, field))
    else:
        target[...] = result.numpy().reshape(target.shape)


_loaded: set[str] = set()


def _initialize() -> None:
    """Start Warp; its C library warns on stderr of a missing GPU, which is no news to a CPU user."""
    sys.stderr.flush()
    stderr, null = os.dup(2), os.open(os.devnull, os.O_WRONLY)
    os.dup2(null, 2)
    try:
        wp.init()
    finally:
        os.dup2(stderr, 2)
        os.close(stderr)
        os.close(null)


def _load(kernel: Any) -> None:
    """Compile or load the kernel's module once, before threads share it, and say so when it has to be compiled."""
    module = kernel.module
    if module.name in _loaded:
        return
    _initialize()
    stamp = os.path.join(wp.config.kernel_cache_dir, ".texloom-" + module.name)
    if not os.path.exists(stamp) and not _Machine.told:
        _Machine.told = True
        print("texloom: compiling kernels (once)", file=sys.stderr)
    wp.load_module(module, device=_Machine.device)
    with open(stamp, "w", encoding="utf-8"):
        pass
    _loaded.add(module.name)
