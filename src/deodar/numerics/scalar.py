"""One number in a formula."""

from __future__ import annotations

from jax import Array

Scalar = Array | float
"""A number of the host, or an array without axes (a tracer in a compiled program)."""
