"""Interaction kernels; every kernel that a module declares is registered."""
