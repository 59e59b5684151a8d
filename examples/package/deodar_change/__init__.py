"""A detector of change for deodar, a world, a measure, a figure and a command."""
