"""One file for each kernel; the folder is the registry."""
