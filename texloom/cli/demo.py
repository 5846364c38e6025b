"""``texloom demo``: everything once, from nothing."""


def demo() -> None:
    """Draw samples and a mesh, texture an image and the mesh, and say where the pictures are."""
