"""The one verb: an exemplar, a domain and a method give sources."""

from typing import Protocol

from texloom.domain.domain import Domain
from texloom.exemplar.exemplar import Exemplar
from texloom.progress import Report, silent
from texloom.synthesis.optimize import Optimize
from texloom.synthesis.result import Result


class Method(Protocol):
    """A frozen dataclass of parameters that can be run."""

    def run(self, exemplar: Exemplar, domain: Domain, *, seed: int, report: Report) -> Result:
        """Grow texture like ``exemplar`` over ``domain``."""
        ...


def synthesize(
    exemplar: Exemplar, domain: Domain, method: Method | None = None, *, seed: int = 0, report: Report = silent
) -> Result:
    """Texture like ``exemplar`` over ``domain``, as sources; ``Optimize()`` unless another method is given.

    The same seed gives the same sources, whatever the number of threads. ``report(stage, done)`` is called between
    batches and may raise ``KeyboardInterrupt``.
    """
    return (method or Optimize()).run(exemplar, domain, seed=seed, report=report)
