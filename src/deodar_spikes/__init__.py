"""From fields to spiking neurons: translation, graphs of NIR, simulation, limits of chips, comparison."""
