"""Modules in the words of other tools, for scripts that were written for them."""
