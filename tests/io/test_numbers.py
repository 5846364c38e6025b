import numpy as np
import pytest

from texloom.io.numbers import floats, integers, table


@pytest.mark.parametrize("form", ["%.6f", "%.6g", "%.15g", "%.17g", "%.3f", "%r", "%+.4f", "%.25f"])
def test_floats_are_rounded_as_python_rounds(form):
    rng = np.random.default_rng(0)
    words = [form % float(value) for value in rng.normal(size=2000) * 10.0 ** rng.integers(-3, 5, 2000)]
    words[10:17] = ["-0.000", "-.5", "5.", "1e-5", "7", "-2.5E+3", "9.87654321098765432"]
    words[20:60] = [f"{value:.18f}" for value in rng.normal(size=40)]  # more digits than a float can tell apart
    expected = np.array([float(word) for word in words])
    assert floats(" \n".join(words).encode()).tobytes() == expected.tobytes()


@pytest.mark.parametrize(
    "text",
    [
        b"v 1.0 1-2.5 .\nv 3.0 4.0 5.0",
        b"v . 1.-5 2.0\nv 1.0 2.0 3.0",
        b"v -. 1.0 2.0\nv 3.0 4.0 5.0",
        b"v 1.2.3 . 1.0\nv 1.0 2.0 3.0",
        b"v 1.0 e 2.0\nv 1.0 2.0 3.0",
        b"v 1.0 2.0 3.0\nv 1.0 2.0 -",
        b"v 1.0 2.0\n3.0 v 4.0 5.0 6.0",
        b"v 1.0\n2.0 3.0\nv 4.0 5.0 6.0",
        b"v 1.0 2.0 3.0 4.0\nv 5.0 6.0",
        b"v 1.0 2.0 3.0 v 4.0 5.0 6.0\n",
        b"vv 1.0 2.0",
        b"v1.0 2.0 3.0 4.0\nv 5.0 6.0 7.0",
    ],
)
def test_a_table_that_cannot_be_meant_is_none(text):
    rows = text.count(b"v")
    many = b"v 1.0 2.0 3.0\n" * 100  # among many that are right
    assert table(text, b"v", rows=rows, numbers=floats) is None
    assert table(many + text, b"v", rows=100 + rows, numbers=floats) is None


def test_a_table_of_integers():
    found = table(b"f 1 +2 -3\nf\t4 5  6 \n", b"f", rows=2, numbers=integers)
    np.testing.assert_array_equal(found, [[1, 2, -3], [4, 5, 6]])
    assert table(b"f 1 2 3\nf 4 5 6.5\n", b"f", rows=2, numbers=integers) is None
