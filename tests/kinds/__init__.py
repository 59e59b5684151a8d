"""Descriptions of kinds."""
