"""A detector of change for deodar, a lamp to look at, and a command."""
