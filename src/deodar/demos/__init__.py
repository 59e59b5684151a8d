"""Demonstrations on real input: `deodar demo NAME`."""
