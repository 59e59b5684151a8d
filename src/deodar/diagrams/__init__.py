"""Pictures of architectures: a plain graph is laid out in layers, painted as shapes, and written as SVG, PDF
or PNG.

The package does not depend on models: `model/diagram.py` makes the graph of a document.
"""
