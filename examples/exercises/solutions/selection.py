"""Solutions of the exercise on selection: the cells of its tasks."""

# task 1
inhibition = 0.5

# task 2
preshape = 0.2
