"""Solutions of the exercise on memory: the cells of its tasks."""

# task 1
excitation = 20

# task 2
positions = [at_the_end(remembering(excitation, center))[0].position[0] for center in (30, 45, 60)]
