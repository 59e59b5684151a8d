"""Values that are computed outside of a compiled program: on the CPU."""

from __future__ import annotations

import contextlib

import jax


def on_cpu() -> contextlib.AbstractContextManager[object]:
    """Compute on the CPU inside this context, also where JAX's own default device is a graphics processor.

    The result of a run on the CPU must not depend on what else a machine has, and each process that computes
    on a graphics processor takes most of its memory.
    """
    return jax.default_device(jax.local_devices(backend="cpu")[0])
