"""The world that the open document senses and moves."""
