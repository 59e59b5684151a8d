"""A bag of ROS 2 as a world: `ros_bag.py` and its parts."""
