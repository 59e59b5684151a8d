"""A plain NumPy reference of the equations, written for being read: loops over time, direct sums over all
pairs of samples.

It shares no code with the engine. It reads parameters from deodar's parts (they are plain data) and computes
in float64.
"""
