"""Importers of other tools' files: one folder per tool, recognised by the content of a file."""
