"""Drawing of records: one file for each kind of figure; the folder is the list of kinds.

A kind is a module with `ACROSS` (whether time runs across), `suits(variable)`, `size(view)`, `fill(place, view)` and
`draw(variable, **view) -> matplotlib.figure.Figure`. Nothing here uses pyplot, so that figures are objects and not global state.
"""
