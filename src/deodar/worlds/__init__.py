"""Worlds that a model is embodied in, one per file; the folder is the registry.

The classes are `dd.Arena`, `dd.Picture` and so on.
"""
