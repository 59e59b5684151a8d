"""Documents, parameters and problems as parts of messages."""
