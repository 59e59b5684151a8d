"""Elements with a state, and sources; every element that a module declares is registered."""
