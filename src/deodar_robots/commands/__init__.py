"""Commands of the command line: robots, and worlds in other processes."""
