"""Pure functions of arrays: axes, sigmoids, kernels, convolution, resampling, noise, integrators."""
