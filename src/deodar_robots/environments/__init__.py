"""Closed loops of deodar as environments of Gymnasium."""
