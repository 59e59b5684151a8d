"""A session that is driven by the wall clock in a thread of its own, and what others watch of it."""
