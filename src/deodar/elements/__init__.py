"""Elements with a state, and sources, one per file; every module in this folder is registered."""
