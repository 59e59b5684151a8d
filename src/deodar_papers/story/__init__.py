"""The first demonstration: the story of one field, and the same on a photograph, each as a moving picture."""
