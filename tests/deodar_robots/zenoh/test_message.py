"""Messages: every array comes back as it was, and no other bytes are read."""

from __future__ import annotations

import contextlib
import struct

import hypothesis.strategies as st
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis.extra.numpy import array_shapes, arrays

from deodar_robots.zenoh.about import HEADER, MAGIC, MOST_BYTES, BadMessage, WireMessage, bundle, unbundle

NUMBERS = st.sampled_from(
    [np.dtype(t) for t in ("f4", "f8", "u1", "u2", "i4", "i8", "u4", "u8", "i1", "i2", "?", ">f8", ">i4")]
)
ARRAYS = NUMBERS.flatmap(lambda dtype: arrays(dtype, array_shapes(min_dims=0, max_dims=4, min_side=0)))
WORDS = st.integers(0, 2**64 - 1)


@given(ARRAYS, WORDS, st.floats(allow_nan=False, allow_infinity=False), WORDS, WORDS)
def test_a_message_is_read_as_it_was_written(array, sequence, time, stamp, answers):
    sent = WireMessage(array, sequence, time, stamp, answers, commander=7, parts=3)
    got = WireMessage.from_bytes(sent.to_bytes())
    np.testing.assert_array_equal(got.array, array)
    assert got.array.dtype == array.dtype.newbyteorder("<") and got.array.shape == array.shape
    assert (got.sequence, got.time, got.stamp, got.answers) == (sequence, time, stamp, answers)
    assert (got.commander, got.parts) == (7, 3)


@given(st.binary(max_size=200))
def test_foreign_bytes_are_refused(raw):
    with pytest.raises(BadMessage):
        WireMessage.from_bytes(raw)


@given(ARRAYS, st.data())
def test_a_message_that_is_cut_or_continued_is_refused(array, data):
    raw = WireMessage(array).to_bytes()
    cut = data.draw(st.integers(0, len(raw) - 1))
    for wrong in (raw[:cut], raw + data.draw(st.binary(min_size=1, max_size=9))):
        with pytest.raises(BadMessage):
            WireMessage.from_bytes(wrong)


@settings(max_examples=300)
@given(ARRAYS, st.data())
def test_changed_bytes_are_refused_or_read_with_the_length_that_they_state(array, data):
    raw = bytearray(WireMessage(array).to_bytes())
    for _ in range(data.draw(st.integers(1, 4))):
        raw[data.draw(st.integers(0, len(raw) - 1))] = data.draw(st.integers(0, 255))
    with contextlib.suppress(BadMessage):
        got = WireMessage.from_bytes(bytes(raw))
        assert got.array.nbytes == len(raw) - HEADER.size - 4 * got.array.ndim


def test_a_header_of_a_huge_array_is_refused_before_anything_is_allocated():
    for shape in ((2**32 - 1,) * 8, (MOST_BYTES + 1,), (0, 2**31, 2**31, 2**31)):
        header = HEADER.pack(MAGIC, 2, len(shape), 1, 0, 0.0, 0, 0, 0)
        with pytest.raises(BadMessage, match="bytes for the shape"):
            WireMessage.from_bytes(header + struct.pack(f"<{len(shape)}I", *shape))
    with pytest.raises(BadMessage, match="too large"):
        WireMessage(np.broadcast_to(np.uint8(0), (MOST_BYTES + 1,))).to_bytes()
    with pytest.raises(BadMessage, match="complex128 has no form"):
        WireMessage(np.zeros(2, complex)).to_bytes()


def test_a_time_that_is_not_finite_is_refused_and_numbers_are_judged_by_finite():
    raw = HEADER.pack(MAGIC, 0, 0, 1, 0, float("nan"), 0, 0, 0) + np.float32(1).tobytes()
    with pytest.raises(BadMessage, match="another header"):
        WireMessage.from_bytes(raw)
    assert not WireMessage.from_bytes(WireMessage(np.float32(np.nan)).to_bytes()).finite
    assert WireMessage.from_bytes(WireMessage(np.float32(1)).to_bytes()).finite
    assert WireMessage.from_bytes(WireMessage(np.uint8(1)).to_bytes()).finite


@given(st.lists(ARRAYS, max_size=4), st.data())
def test_a_bundle_is_read_whole_or_refused(given_arrays, data):
    raw = bundle([WireMessage(a, k) for k, a in enumerate(given_arrays)])
    found = unbundle(raw)
    assert [m.sequence for m in found] == list(range(len(given_arrays)))
    for a, m in zip(given_arrays, found, strict=True):
        np.testing.assert_array_equal(m.array, a)
    with pytest.raises(BadMessage):
        unbundle(raw + data.draw(st.binary(min_size=1, max_size=3)))
