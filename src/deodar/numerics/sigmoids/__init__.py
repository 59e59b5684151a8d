"""Sigmoids, one per file; every module in this folder is registered."""
