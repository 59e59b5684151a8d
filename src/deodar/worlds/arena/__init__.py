"""An arena with a vehicle in it: layout, objects, contact, sensors and view. The world is `dd.Arena`."""

from __future__ import annotations

from deodar import renamed

__getattr__ = renamed.left(__name__)
