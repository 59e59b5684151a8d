"""One file for a colleague: what is packed, the modules of the user that it needs, and the way back."""
