"""Experiments: trials with actions, events and measures, one row per trial; the results do not depend on the
pieces in which trials are run.
"""
