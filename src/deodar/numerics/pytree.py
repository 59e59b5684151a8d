"""Nested arrays, as JAX takes them."""

from __future__ import annotations

from typing import Any

PyTree = Any
"""Arrays in nested dictionaries, lists, tuples and dataclasses; `None` is an empty one. JAX has no type that
states what they hold.
"""
