"""Solutions of the exercise on forgetting: the cells of its tasks."""

# task 1
boost = -3

# task 2
until = 600
