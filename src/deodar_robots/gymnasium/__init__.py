"""Environments of Gymnasium as worlds."""
