"""What can go wrong, drawn as a tree.

TexloomError            everything below; one clear line, with numbers and the way out
├─ ExemplarError        a sample that cannot be used
├─ MeshError            a mesh that cannot be read or mended
├─ FieldError           a direction or scale field that cannot be built
├─ ParameterError       a parameter outside its range, or two that contradict each other
└─ FileError            a file that cannot be read or written

All are also ``ValueError``; the command line prints their text and exits with status 2.
"""


class TexloomError(ValueError):
    """Base of every error a user can cause."""


class ExemplarError(TexloomError):
    """The sample cannot be used."""


class MeshError(TexloomError):
    """The mesh cannot be read or mended."""


class FieldError(TexloomError):
    """The direction or scale field cannot be built."""


class ParameterError(TexloomError):
    """A parameter is out of range, or two contradict each other."""


class FileError(TexloomError):
    """A file cannot be read or written."""
