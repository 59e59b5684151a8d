"""A robot that a file describes: the world `robot.py` and its parts, a file each."""
