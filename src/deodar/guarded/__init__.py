"""Reading files of others in a child process, with a limit of memory and of time."""
