"""The document: pure data, JSON in and out, check, edit with undo; and `Model`, the builder a script
holds.
"""
