"""Reading compressed pictures of messages in a child process."""

from __future__ import annotations

import io

import numpy as np

from deodar.errors import WorldError

FORMATS = ("JPEG", "PNG")


def pixels_of(content: bytes, most_bytes: int) -> np.ndarray:
    """Return the pixels of a JPEG or PNG file, bytes, height x width x 3.

    Raises:
        WorldError: it is neither, or has more than `most_bytes` bytes of pixels.
    """
    # start-up time
    from PIL import Image

    size = "too many"
    try:
        with Image.open(io.BytesIO(content), formats=FORMATS) as picture:
            if picture.width * picture.height * 3 <= most_bytes:
                return np.asarray(picture.convert("RGB"))
            size = f"{picture.width} x {picture.height}"
    except MemoryError:
        raise
    except Image.DecompressionBombError:
        pass  # Pillow has a limit of its own
    except Exception:  # damaged files may raise any exception
        raise WorldError("is no JPEG or PNG file") from None
    raise WorldError(f"has {size} pixels; at most {most_bytes // 3} are read")
