"""Sealed bytes and NumPy archives: what is damaged is refused before it is parsed."""

from __future__ import annotations

import io
import zipfile

import numpy as np
import pytest

from deodar import npz, sealed
from deodar.errors import DamagedFile


def test_sealed_bytes_come_back_and_each_flipped_bit_is_refused() -> None:
    content = sealed.seal(b"activation")
    assert bytes(sealed.unseal(content)) == b"activation" and bytes(sealed.unseal(sealed.seal(b""))) == b""
    for bit in range(8 * len(content)):
        flipped = bytearray(content)
        flipped[bit // 8] ^= 1 << (bit % 8)
        with pytest.raises(DamagedFile):
            sealed.unseal(bytes(flipped))
    for end in range(len(content)):
        with pytest.raises(DamagedFile):
            sealed.unseal(content[:end])
    with pytest.raises(DamagedFile):
        sealed.unseal(content + b"\0")


def npy(shape: tuple[int, ...], values: bytes, descr: str = "<f8") -> bytes:
    """Return the content of an .npy file whose header states a shape."""
    file = io.BytesIO()
    np.lib.format.write_array_header_1_0(file, {"descr": descr, "fortran_order": False, "shape": shape})
    return file.getvalue() + values


def archive(content: bytes) -> bytes:
    file = io.BytesIO()
    with zipfile.ZipFile(file, "w") as z:
        z.writestr("a.npy", content)
    return file.getvalue()


def test_an_archive_returns_what_was_packed() -> None:
    named = {"a": np.arange(6.0).reshape(2, 3).T, "b": np.array("text"), "c": np.zeros((0, 2), np.int8)}
    read = dict(npz.arrays(npz.packed(named)))
    assert list(read) == list(named)
    for name, array in named.items():
        assert read[name].dtype == array.dtype and np.array_equal(read[name], array)
        assert read[name].flags.writeable


@pytest.mark.parametrize("shape", [(10**13,), (2**40, 2**40), (3,), (1,)])
def test_an_array_that_states_another_size_than_it_has_is_refused(shape: tuple[int, ...]) -> None:
    with pytest.raises(ValueError, match="states"):
        dict(npz.arrays(archive(npy(shape, bytes(16)))))


def test_objects_are_refused_and_sizes_are_limited() -> None:
    with pytest.raises(ValueError, match="objects"):
        dict(npz.arrays(archive(npy((2,), bytes(16), "|O"))))
    with pytest.raises(MemoryError, match="left"):
        dict(npz.arrays(archive(npy((2,), bytes(16))), most=100))
    with pytest.raises(ValueError):
        dict(npz.arrays(b"PK nonsense"))
