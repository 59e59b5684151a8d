"""The open document and all that belongs to it: history, file, run and record."""
