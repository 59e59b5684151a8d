"""Whole runs: trials and sweep points in one program, in pieces, or in worker processes."""
