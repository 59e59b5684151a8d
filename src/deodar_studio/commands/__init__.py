"""Commands of the command line: the studio."""
