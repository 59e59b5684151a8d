"""Robots, simulators, networks and recordings as worlds, and closed loops as environments."""
