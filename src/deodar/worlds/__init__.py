"""What a model is embodied in: one file each; the folder is the registry."""
