"""Conversion of models and records to files of other tools."""
