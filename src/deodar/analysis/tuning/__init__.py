"""Tuning: values of parameters at which a field has a stated regime."""
