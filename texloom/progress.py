"""Long work reports through one plain callback: ``report(stage, done)``, with ``done`` in [0, 1].

A callback may raise ``KeyboardInterrupt`` to stop the work between two batches; nothing is half-written then.
"""

from collections.abc import Callable

Report = Callable[[str, float], None]


def silent(stage: str, done: float) -> None:
    """The report that says nothing."""
