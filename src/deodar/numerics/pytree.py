"""The type of PyTrees, the nested arrays of JAX."""

from __future__ import annotations

from typing import Any

PyTree = Any
"""Arrays in nested dictionaries, lists, tuples and dataclasses; `None` is an empty PyTree.

JAX has no type for their content.
"""
