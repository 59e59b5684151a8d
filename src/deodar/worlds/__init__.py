"""What a model is embodied in: one file each; the folder is the registry.

The classes are `dd.Arena`, `dd.Picture` and so on.
"""
