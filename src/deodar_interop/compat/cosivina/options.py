"""The option that scripts of the Python port read."""

useNumba = False
"""Whether Numba compiles the elements: never here."""
