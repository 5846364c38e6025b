"""Numbers written as text, a whole table at one go."""

import warnings
from collections.abc import Callable

import numpy as np
from jaxtyping import Float64, Int64, Num

_LARGEST = 2**53  # integers up to here are exact as floats
_LONGEST = 20  # letters of a number with a sign and a point whose digits surely fit into 64 bits
_FEW = 0.05  # of the words
_TENS = np.array([float(10**power) for power in range(23)])  # as many as are exact


def table(
    text: bytes, keyword: bytes, *, rows: int, numbers: Callable[[bytes], Num[np.ndarray, "word"]]
) -> Num[np.ndarray, "row column"] | None:
    """The numbers behind a keyword of one letter, as many in every line; None unless each line is just that.

    ``rows`` is how often the letter is in the text, ``numbers`` one of the functions below.
    """
    text = text.rstrip()
    codes, starts, _ = _words(text)
    words, left = divmod(len(starts), rows)
    if left or words < 2 or text.count(b"\n") != rows - 1:
        return None
    heads = starts[::words]
    is_keyword = (codes[heads] == ord(keyword)) & (codes[heads + 1] <= ord(" "))
    if not is_keyword.all() or (codes[heads[1:] - 1] != ord("\n")).any():
        return None
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error")  # NumPy's way to say that a word is no number
            found = numbers(text.replace(keyword, b" "))
    except (ValueError, DeprecationWarning):
        return None
    return found.reshape(rows, -1) if len(found) == len(starts) - rows else None


def integers(text: bytes) -> Int64[np.ndarray, "word"]:
    """Words as integers; those too large are not told from the largest."""
    return np.fromstring(text, np.int64, sep=" ")


def floats(text: bytes) -> Float64[np.ndarray, "word"]:
    """Words as numbers, rounded as ``float`` rounds."""
    decimals = _decimals(text)
    return np.fromstring(text, np.float64, sep=" ") if decimals is None else decimals


def _decimals(text: bytes) -> np.ndarray | None:
    """Numbers most of which are plain decimals; None for others.

    Ten times as fast as reading floats: a decimal is an integer divided by a power of ten. With both exact the
    quotient is rounded once, and so rounded right. The odd ones among them are read one by one.
    """
    codes, starts, ends = _words(text)
    if len(starts) == 0:
        return None
    codes = codes.copy()
    points = np.add.reduceat(codes == ord("."), starts, dtype=np.int64)
    has_exponent = np.logical_or.reduceat((codes | 0x20) == ord("e"), starts)
    is_odd = (points != 1) | has_exponent | (ends - starts > _LONGEST)
    if np.count_nonzero(is_odd) > _FEW * len(starts):
        return None
    negative = codes[starts] == ord("-")
    for start, end in zip(starts[is_odd], ends[is_odd], strict=True):
        codes[start:end] = ord("0")
    sign = np.flatnonzero((codes == ord("-")) | (codes == ord("+")))  # one inside a word would make it two
    if (codes[sign - 1] > ord(" ")).any():
        return None
    digits = integers(codes.tobytes().replace(b".", b""))
    if len(digits) != len(starts):
        return None
    point = ends - 1
    point[~is_odd] = np.flatnonzero(codes == ord("."))
    value = np.copysign(digits / _TENS[ends - 1 - point], np.where(negative, -1.0, 1.0))  # -0.0 too
    is_odd |= np.abs(digits) >= _LARGEST
    if np.count_nonzero(is_odd) > _FEW * len(starts):
        return None
    value[is_odd] = [float(text[start:end]) for start, end in zip(starts[is_odd], ends[is_odd], strict=True)]
    return value


def _words(text: bytes) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The bytes of a text, where its words start, and where they end."""
    codes = np.frombuffer(text, np.uint8)
    within = np.zeros(len(codes) + 2, bool)
    np.greater(codes, ord(" "), out=within[1:-1])
    bounds = np.flatnonzero(within[1:] != within[:-1])
    return codes, bounds[::2], bounds[1::2]
