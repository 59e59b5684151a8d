"""A plot of the studio: values over a periodic axis as a closed curve around a circle."""

TITLE = "Polar plot"
FILE = "polar.js"
AXES = 1
PERIODIC = True
