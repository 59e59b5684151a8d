"""Records: labelled arrays with their provenance, files, repetition."""
