"""Packages that extend deodar."""
