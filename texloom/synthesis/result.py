"""What a synthesis returns: the sources, and how it went."""

from dataclasses import dataclass, field

from texloom.sources import SourceMap


@dataclass(frozen=True, eq=False)
class Result:
    """``energy`` is the mean squared difference per pass (encoded colour units), ``seconds`` the time by stage."""

    sources: SourceMap
    energy: tuple[float, ...] = ()
    seconds: dict[str, float] = field(default_factory=dict)
    stopped: str = "done"
    patches: int = 0
