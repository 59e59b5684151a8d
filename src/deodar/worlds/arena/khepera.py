"""The dimensions and sensors of the Khepera robot, as Sandamirskaya & Schöner (2010) use it.

Sources:
    Mondada, Franzi & Ienne (1993), Mobile robot miniaturisation: a tool for investigation in control
    algorithms, Experimental Robotics III; and the robot's user manual (K-Team): a round robot of 55 mm,
    wheels 53 mm apart, encoders of 600 pulses per turn of a wheel and 12 pulses per mm, at most 127 pulses in
    10 ms. Sandamirskaya & Schöner (2010), Neural Netw. 23, 1164-1179, appendix A and table B.1: the angles of
    the six infrared sensors, there positive to the right.

The paper computes distances from infrared readings by a calibration of its robot. Here a reading is the
distance itself. Not published, and chosen: the range of 100 mm, the noise of 5 %, and the camera: 60 x 45
degrees, above the middle of the axle, at 40 mm, because the robot without turrets is about 30 mm high.
"""

from __future__ import annotations

from math import cos, pi, radians, sin

from deodar.worlds.arena.vehicle import Infrared, Vehicle, VehicleCamera

RADIUS = 0.0275
PULSES_PER_TURN = 600.0
PULSES_PER_METRE = 12_000.0

# from the left to the right; the paper's table is positive to the right, angles here to the left
TO_THE_RIGHT = (-90.0, -45.0, -9.0, 11.0, 45.0, 90.0)
ANGLES = tuple(-radians(a) for a in TO_THE_RIGHT)

RANGE = 0.1
FAR = 10_000.0
"""Reading beyond the range, mm."""

KHEPERA = Vehicle(
    name="khepera",
    radius=RADIUS,
    wheel_radius=PULSES_PER_TURN / PULSES_PER_METRE / (2 * pi),
    axle=0.053,
    steps_per_turn=PULSES_PER_TURN,
    fastest=12_700.0,
    infrared=Infrared(
        forward=tuple(RADIUS * cos(a) for a in ANGLES),
        left=tuple(RADIUS * sin(a) for a in ANGLES),
        angles=ANGLES,
        distances=(0.0, RANGE, RANGE),
        readings=(0.0, 1000 * RANGE, FAR),
        noise=(0.05, 0.05, 0.0),
        meaning=f"distances from the rim, from the left to the right; {FAR:.0f} beyond {1000 * RANGE:.0f} mm",
        unit="mm",
        reflects=False,
    ),
    camera=VehicleCamera(radians(60), radians(45), height=0.04),
)
