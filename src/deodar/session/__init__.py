"""One running model: its state, clock and world; the session that scripts hold, and its pace."""
