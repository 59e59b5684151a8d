"""The studio behind its page: a small server that translates messages and holds no science."""
