"""Files of other tools, made into models: one folder for each tool, found by what a file holds."""
