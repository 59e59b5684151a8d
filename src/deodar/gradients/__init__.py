"""The step of a model as pure functions for JAX: gradients, fits and rollouts."""
