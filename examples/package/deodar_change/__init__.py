"""A detector of change for deodar, a world, a measure, a figure, a plot of the studio and a command."""
