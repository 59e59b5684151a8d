"""Records as other tools write them."""
