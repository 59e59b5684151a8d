"""Solutions of the exercise on detection: the cells of its tasks."""

# task 1
smallest = 4.3

# task 2
stays = 2.7
