"""A readable NumPy reference of the equations: loops over time, direct sums over all pairs of samples.

It shares no code with the engine. It reads the parameters of deodar's kinds, which are plain data, and
computes in float64.
"""
