"""The messages between the server and the page, and the binary frames of arrays."""
