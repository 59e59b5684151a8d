"""A robot, or a world of another process, over Zenoh."""
