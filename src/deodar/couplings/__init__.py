"""Elements between elements: one file each; the folder is the registry."""
