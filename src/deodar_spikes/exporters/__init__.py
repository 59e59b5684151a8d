"""Conversion of models to networks of spiking neurons."""
