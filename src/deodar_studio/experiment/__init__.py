"""The open experiment, its file and its run."""
