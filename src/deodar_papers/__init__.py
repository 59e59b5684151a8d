"""Published experiments, run again: a folder for each paper, their figures, and two commands."""
