"""From neural fields to spiking neurons: translation, files of NIR, simulation, limits of chips."""
