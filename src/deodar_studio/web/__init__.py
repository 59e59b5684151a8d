"""The web application, and the sockets of the pages."""
