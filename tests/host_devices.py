"""A CPU that counts as several devices of JAX, for processes that tests start."""

from __future__ import annotations

import os


def flags(devices: int) -> str:
    """Return XLA_FLAGS for a process with some devices, whose programs are compiled as those of the tests."""
    return f"{os.environ.get('XLA_FLAGS', '')} --xla_force_host_platform_device_count={devices}".strip()
