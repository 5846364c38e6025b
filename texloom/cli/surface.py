"""``texloom surface``: texture over a mesh."""


def surface() -> None:
    """Grow texture over a mesh, along a direction and a scale field."""
