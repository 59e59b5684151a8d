"""One running model: its state, clock and world; the session for scripts, and its pace."""
