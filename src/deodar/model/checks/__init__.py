"""Checks of the whole graph: one family of mistakes a file, each with `check(wiring)`; the folder is the list
of them.
"""
