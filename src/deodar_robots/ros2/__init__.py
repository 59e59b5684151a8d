"""A robot that uses ROS 2, as a world, without an installation of ROS: `ros2.py` and its parts."""
