"""Commands of the command line: comparison with spiking networks."""
