"""A place between texels: which texels are read there, and what each counts for."""

import warp as wp

CURVE = wp.constant(4.0 / 3.0)  # of the curvature: 1 is the cubic of Catmull and Rom, which is softer; 3/2 rings


@wp.func
def tap_place(row: float, column: float, rows: int, columns: int):
    """Upper left texel of a place, clamped at the border, and its fractions: (row, column, of a row, of a column)."""
    r = wp.clamp(row, 0.0, float(rows - 1))
    c = wp.clamp(column, 0.0, float(columns - 1))
    r0 = wp.floor(r)
    c0 = wp.floor(c)
    return wp.vec4(r0, c0, r - r0, c - c0)


@wp.func
def mix4(a: float, b: float, c: float, d: float, fr: float, fc: float):
    """Bilinear mean of the four texels around a point; exactly ``a`` where both fractions are 0."""
    return (1.0 - fr) * ((1.0 - fc) * a + fc * b) + fr * ((1.0 - fc) * c + fc * d)


@wp.func
def cubic(f: float) -> wp.vec4:
    """What texels a, b, c and d at -1, 0, 1 and 2 count for at ``f`` in [0, 1].

    The line from b to c, less ``CURVE`` times f (1 - f) / 2 of the curvature there, which is that of b and c (their
    neighbours' sum less twice their own) in between. Straight slopes are kept, and whole texels.
    """
    g = 1.0 - f
    s = 0.5 * CURVE * f * g
    return wp.vec4(-s * g, g - s * (f - 2.0 * g), f - s * (g - 2.0 * f), -s * f)


@wp.func
def four_around(first: float, count: int) -> wp.vec4i:
    """Texels -1, 0, 1 and 2 from ``first`` on; beyond the border that is repeated."""
    at = int(first)
    last = count - 1
    return wp.vec4i(
        wp.clamp(at - 1, 0, last), wp.clamp(at, 0, last), wp.clamp(at + 1, 0, last), wp.clamp(at + 2, 0, last)
    )
