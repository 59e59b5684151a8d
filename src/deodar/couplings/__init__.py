"""Elements that transform signals between elements, one per file; every module is registered."""
