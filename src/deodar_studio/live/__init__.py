"""A session driven by the wall clock in its own thread, and the data that it publishes."""
