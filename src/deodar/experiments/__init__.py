"""Experiments: trials with actions, events and measures; one row each; carried out in any pieces with the
same result.
"""
