"""Checks of the whole graph, one family of mistakes per file, each with `check(wiring)`; the folder is the
list.
"""
