"""Measuring: peaks, instabilities, regimes, phase plots."""
