"""Figures of runs of papers."""
