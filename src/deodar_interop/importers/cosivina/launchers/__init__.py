"""Launchers: MATLAB scripts that build a simulator of cosivina and its window. They are read, never run."""
