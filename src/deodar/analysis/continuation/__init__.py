"""Steady states of a model as functions of its parameters, and the bifurcations among them."""
