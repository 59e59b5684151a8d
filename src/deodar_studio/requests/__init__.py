"""The handlers of the requests of pages."""
