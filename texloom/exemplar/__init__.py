"""What to imitate: aligned maps, their pyramid, what matching compares, and their patches."""

from texloom.exemplar.exemplar import Exemplar, Map, from_array

__all__ = ["Exemplar", "Map", "from_array"]
