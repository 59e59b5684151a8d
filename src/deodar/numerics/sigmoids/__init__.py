"""One file for each sigmoid; the folder is the registry."""
