"""Write a video that is green, and a record of a run whose sensor saw blue."""

import cv2
import numpy as np

import deodar as dd
from deodar.recording import files

writer = cv2.VideoWriter("green.avi", cv2.VideoWriter.fourcc(*"MJPG"), 10.0, (40, 40))
for _ in range(20):
    writer.write(np.full((40, 40, 3), (0, 255, 0), np.uint8))
writer.release()
blue = dd.Picture(np.full((40, 40, 3), (0, 0, 255), np.uint8))
model = dd.load("saliency.json")
run = dd.simulate(model, 40_000, record=["eye.output"], every=1000, world=blue)
files.save_record(run, "seen.zarr")
