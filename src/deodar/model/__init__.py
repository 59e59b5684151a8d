"""The document (pure data, read from and written to JSON), its checks and edits, and `Model`, which builds
it.
"""
