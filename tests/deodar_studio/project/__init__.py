"""Tests of the parts of the open document, each alone."""
