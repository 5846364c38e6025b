"""Launches: the same result on any number of threads, arrays in structs, and a kernel launched again and again."""

from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest
import warp as wp

from texloom.kernels.launch import Lasting, Repeated, launch, parallel_map, thread_count, use


@wp.kernel(enable_backward=False)
def deal(
    start: int, first: int, step: int, source: wp.array(dtype=wp.vec2), total: wp.array(dtype=float),
    seen: wp.array(dtype=int),
):  # fmt: skip
    """Every ``step``-th value of ``source`` from ``first`` + item on, into total[item]; how often, into seen[item]."""
    item = start + wp.tid()
    for i in range(first + item, source.shape[0], step):
        total[item] = total[item] + source[i][0] - source[i][1]
        seen[item] = seen[item] + 1


@wp.struct
class Ledger:
    """Arrays and a number of different kinds."""

    value: wp.array(dtype=wp.vec2)
    of: wp.array2d(dtype=int)
    share: float


@wp.kernel(enable_backward=False)
def book(start: int, given: Ledger, kept: Ledger):
    """kept.value[item] = given.share · given.value[given.of[item, 1]] - kept.share; kept.of[item] counts up."""
    item = start + wp.tid()
    kept.value[item] = given.share * given.value[given.of[item, 1]] - wp.vec2(kept.share, kept.share)
    kept.of[item, 0] = kept.of[item, 0] + 1


@pytest.fixture(params=[1, 2, 3])
def threads(request: pytest.FixtureRequest) -> Iterator[int]:
    """That many threads, then as many as before."""
    before = thread_count()
    use(threads=request.param)
    yield request.param
    use(threads=before)


def test_a_kernel_runs_again_with_other_numbers_on_the_same_arrays(threads):
    rng = np.random.default_rng(0)
    source = rng.integers(-9, 9, (40, 2)).astype(np.float32)
    total, seen = np.zeros(4, np.float32), np.zeros(4, np.int32)
    again = Repeated(deal, 2, inputs=[source], outputs=[total, seen])
    expected, count = np.zeros(4), np.zeros(4, int)
    for items, first, step in [(2, 0, 3), (4, 5, 4), (1, 39, 1), (3, 7, 50), (4, 0, 1)]:
        source[:] = source[::-1]  # what changes in place is seen
        again.run(items, first, step)
        for item in range(items):
            expected[item] += (source[first + item :: step] @ [1, -1]).sum()
            count[item] += len(source[first + item :: step])
        np.testing.assert_array_equal(total, expected)
        np.testing.assert_array_equal(seen, count)


def test_the_varying_numbers_are_counted():
    again = Repeated(
        deal, 2, inputs=[np.zeros((1, 2), np.float32)], outputs=[np.zeros(1, np.float32), np.zeros(1, np.int32)]
    )
    with pytest.raises(AssertionError, match="2 numbers precede the inputs"):
        again.run(1, 0)


def test_arrays_must_lie_as_kernels_read_them():
    with pytest.raises(AssertionError, match="source: kernels take C-contiguous arrays"):
        Repeated(deal, 2, inputs=[np.zeros((4, 4), np.float32)[:, ::2]], outputs=[])


def test_chunks_make_no_difference(threads):
    source = np.ones((1000, 2), np.float32) * [3, 1]
    total, seen = np.zeros(1000, np.float32), np.zeros(1000, np.int32)
    launch(deal, 1000, inputs=[0, 1000, source.astype(np.float32)], outputs=[total, seen], grain=7)
    assert (total == 2).all() and (seen == 1).all()
    assert parallel_map(lambda i: i * i, 5) == [0, 1, 4, 9, 16]


def ledgers(count: int) -> tuple[dict[str, Any], dict[str, Any]]:
    """One to read, one to write; fields in another order than the struct's."""
    rng = np.random.default_rng(1)
    of = rng.integers(0, count, (count, 2)).astype(np.int32)
    value = rng.random((count, 2), np.float32)
    given = {"share": 3.0, "of": of, "value": value}
    return given, {"value": np.zeros_like(value), "share": 0.5, "of": np.zeros_like(of)}


def test_structs_are_dicts_of_their_fields_read_and_written_in_place(threads):
    given, kept = ledgers(500)
    read = {name: np.copy(part) for name, part in given.items()}
    for _ in range(2):
        launch(book, 500, inputs=[given], outputs=[kept], grain=7)
    np.testing.assert_allclose(kept["value"], 3 * read["value"][read["of"][:, 1]] - 0.5, rtol=1e-6)
    assert (kept["of"] == [2, 0]).all()
    for name, part in given.items():
        np.testing.assert_array_equal(part, read[name])


def test_structs_that_last_are_shared_once_and_see_what_their_arrays_hold():
    fields = {"value": np.ones((3, 2), np.float32), "of": np.array([[0, k] for k in (2, 0, 1)], np.int32), "share": 2.0}
    kept = {"value": np.zeros((3, 2), np.float32), "of": np.zeros((3, 2), np.int32), "share": 0.0}
    given = Lasting(fields)
    launch(book, 3, inputs=[given], outputs=[kept])
    shared = given.view
    np.testing.assert_array_equal(kept["value"], np.full((3, 2), 2))
    fields["value"][:] = [[1, 2], [3, 4], [5, 6]]
    launch(book, 3, inputs=[given], outputs=[kept])
    assert given.view is shared
    np.testing.assert_array_equal(kept["value"], [[10, 12], [2, 4], [6, 8]])


def test_arrays_in_structs_must_lie_as_kernels_read_them():
    given, kept = ledgers(8)
    given["of"] = np.asfortranarray(given["of"])
    with pytest.raises(AssertionError, match="given.of: kernels take C-contiguous arrays"):
        launch(book, 8, inputs=[given], outputs=[kept])


def test_a_field_that_the_struct_has_not_is_refused():
    given, kept = ledgers(8)
    with pytest.raises(KeyError, match="total"):
        launch(book, 8, inputs=[given | {"total": 1.0}], outputs=[kept])


def test_what_an_item_raises_is_raised_here(threads):
    def fail(item: int) -> None:
        if item == 1:
            raise ValueError("stop")

    with pytest.raises(ValueError, match="stop"):
        parallel_map(fail, 3)
