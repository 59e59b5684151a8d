"""An event camera on a pan-tilt unit in front of a screen: the world `eye.py` and its parts, a file each."""
