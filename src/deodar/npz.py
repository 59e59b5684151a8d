"""NumPy archives (.npz): arrays by name, never pickled. Sizes are checked before memory is taken for them."""

from __future__ import annotations

import io
import math
import zipfile
from collections.abc import Iterator, Mapping

import numpy as np

SUFFIX = ".npy"


def packed(named: Mapping[str, np.ndarray]) -> bytes:
    """Return an archive of arrays, without compression."""
    content = io.BytesIO()
    np.savez(content, allow_pickle=False, **named)
    return content.getvalue()


def arrays(content: bytes | memoryview, most: float = math.inf) -> Iterator[tuple[str, np.ndarray]]:
    """Yield the arrays of an archive with their names.

    Args:
        content: its bytes.
        most: largest number of bytes of all arrays together.

    Raises:
        ValueError: it is no archive of arrays, is damaged, or states more numbers than it holds.
        MemoryError: its arrays need more than `most` bytes.
    """
    try:
        with zipfile.ZipFile(io.BytesIO(content)) as archive:
            entries = archive.infolist()
            need = sum(entry.file_size for entry in entries)
            if need > most:
                raise MemoryError(f"needs {need / 2**30:,.1f} GiB; {most / 2**30:,.1f} GiB are left")
            for entry in entries:
                yield entry.filename.removesuffix(SUFFIX), _array(archive.read(entry))
    except (MemoryError, ValueError):
        raise
    except Exception as error:  # zipfile raises errors of many classes for damaged bytes
        raise ValueError(f"{type(error).__name__}: {error}") from None


def _array(content: bytes) -> np.ndarray:
    """Return an array from the content of an .npy file."""
    file = io.BytesIO(content)
    version = np.lib.format.read_magic(file)
    read_header = {(1, 0): np.lib.format.read_array_header_1_0, (2, 0): np.lib.format.read_array_header_2_0}
    if version not in read_header:
        raise ValueError(f"an array of version {version}")
    shape, fortran, dtype = read_header[version](file)
    if dtype.hasobject:
        raise ValueError("an array of Python objects")
    stated, bytes_left = math.prod(shape) * dtype.itemsize, len(content) - file.tell()
    if stated != bytes_left:
        raise ValueError(f"an array that states {stated} bytes and has {bytes_left}")
    values = np.frombuffer(content, dtype, offset=file.tell())
    return values.reshape(shape, order="F" if fortran else "C").copy("K")
