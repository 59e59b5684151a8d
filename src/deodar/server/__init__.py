"""The server of the studio: it translates messages between the page and a running model."""
