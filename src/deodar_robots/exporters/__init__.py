"""Conversion of records to bags of ROS 2."""
