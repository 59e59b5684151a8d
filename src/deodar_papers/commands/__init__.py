"""Commands of the command line: papers, and their quick forms."""
