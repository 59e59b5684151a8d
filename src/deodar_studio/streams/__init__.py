"""Frames of arrays and time courses, of the run and of records."""
