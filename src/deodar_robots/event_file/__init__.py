"""Recorded events, and videos turned into events: the world `event_file.py` and its parts, a file each."""
