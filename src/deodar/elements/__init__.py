"""Elements with a state or a source: one file each; the folder is the registry."""
