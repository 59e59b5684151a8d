"""Conversion of files of other tools to models: a folder for each tool."""
