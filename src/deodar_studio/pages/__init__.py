"""The connected pages, and all that they share."""
