"""Runs, sessions and simulate: the only owners of live state."""
