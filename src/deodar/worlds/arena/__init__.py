"""An arena with a vehicle in it: layout, objects, contact, sensors and view. The world is `dd.Arena`."""
