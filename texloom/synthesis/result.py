"""What a synthesis returns: the sources, and how it went."""

from dataclasses import dataclass, field

from texloom.sources import SourceMap


@dataclass(frozen=True, eq=False)
class Result:
    """How a synthesis went beside what it made.

    ``energy`` is the mean squared difference per pass (encoded colour units), ``curves`` what else a method counts per
    pass, by name and unit as a reader meets it ("changed pixels"), ``seconds`` the time by stage.
    """

    sources: SourceMap
    energy: tuple[float, ...] = ()
    seconds: dict[str, float] = field(default_factory=dict)
    stopped: str = "done"
    patches: int = 0
    curves: dict[str, tuple[float, ...]] = field(default_factory=dict)
