"""Elements that transform signals between elements; every one that a module declares is registered."""
