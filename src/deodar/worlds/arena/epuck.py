"""The dimensions and sensors of the e-puck robot.

Sources:
    Mondada et al. (2009), The e-puck, a robot designed for education in engineering, 9th Conf. on Autonomous
    Robot Systems and Competitions: a round robot of 7 cm with two stepper motors and eight infrared sensors;
    20 steps per turn and a gear of 1:50. Billing, Lowe & Sandamirskaya (2015), Adapt. Behav. 23(5), and its
    published simulator: wheels of 41 mm, an axle of 52 mm, 1000 steps per turn, the angles of the sensors.
    The model of the robot in the simulator Webots 7, as public projects quote it: radius of the body, table
    of the sensors. The model of the robot in Webots (E-puck.proto): a horizontal field of view of 0.84 rad
    and 52 x 39 pixels, position of the camera.
"""

from __future__ import annotations

from math import atan, pi, tan

from deodar.worlds.arena.vehicle import Infrared, Vehicle, VehicleCamera

# Sensor 0 is at the right of the front; the others follow clockwise round the robot. The angles are those of
# the published controller; the positions are general knowledge of the robot, accurate to a millimetre or two.
FORWARD = (0.030, 0.022, 0.0, -0.030, -0.030, 0.0, 0.022, 0.030)
LEFT = (-0.010, -0.025, -0.031, -0.015, 0.015, 0.031, 0.025, 0.010)
ANGLES = tuple(a - pi / 2 for a in (1.27, 0.77, 0.0, 5.21, 4.21, 3.14159, 2.37, 1.87))

EPUCK = Vehicle(
    name="e-puck",
    radius=0.037,
    wheel_radius=0.0205,
    axle=0.052,
    steps_per_turn=1000.0,
    fastest=1000.0,
    infrared=Infrared(
        FORWARD,
        LEFT,
        ANGLES,
        distances=(0.0, 0.005, 0.01, 0.02, 0.03, 0.04, 0.05, 0.06, 0.07),
        readings=(4095.0, 3474.0, 2211.0, 676.0, 306.0, 164.0, 90.0, 56.0, 34.0),
        noise=(0.005, 0.037, 0.071, 0.105, 0.125, 0.206, 0.269, 0.438, 0.704),
        meaning="infrared sensors, from the right of the front clockwise; large when near",
    ),
    camera=VehicleCamera(0.84, 2 * atan(tan(0.42) * 39 / 52), height=0.028, forward=0.03),
)
