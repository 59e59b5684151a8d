"""Records: labelled arrays with what made them, files, repetition."""
