#!/usr/bin/env python3
"""Writes opencv_distortion.txt: OpenCV's answers that the lens distortion tests compare with.

Usage: make_opencv_table.py > opencv_distortion.txt   (needs python3-opencv and python3-numpy; not part of the build)

Lines: `set MODEL WIDTH HEIGHT FX FY CX CY  K1 K2 P1 P2 K3 K4 K5 K6` begins a calibration, the principal point in
OpenCV's convention. `project X Y Z U V` is cv::projectPoints of a point in the camera frame (metres to pixels);
`undistort U V X Y` is cv::undistortPoints of a pixel, iterated to convergence (pixels to normalised coordinates).
"""

import cv2
import numpy as np

# Names, sizes and focal lengths of usual depth cameras; the coefficients are round numbers of their usual size.
CALIBRATIONS = [
    ("plumb_bob", 640, 480, 525.0, 525.0, 319.5, 239.5, [0, 0, 0, 0, 0]),
    ("plumb_bob", 640, 480, 580.0, 582.5, 314.0, 245.25, [-0.08, 0.15, -0.001, 0.0007, -0.09]),
    ("plumb_bob", 512, 424, 365.5, 365.5, 255.5, 207.0, [0.09, -0.27, 0.0005, -0.0004, 0.095]),
    ("plumb_bob", 848, 480, 425.0, 424.0, 421.5, 240.75, [-0.055, 0.062, -0.0002, 0.0009, -0.02]),
    ("plumb_bob", 640, 480, 600.0, 600.0, 320.0, 240.0, [-0.2, 0.05, 0.002, -0.0015]),
    ("rational", 640, 576, 504.0, 504.25, 320.5, 333.0, [5.13, 3.49, -0.00008, 0.00004, 0.18, 5.46, 5.17, 0.96]),
    ("rational", 512, 512, 252.0, 252.0, 256.25, 257.5, [0.9, 0.12, 0.0004, -0.0003, 0.004, 1.23, 0.33, 0.018]),
    ("rational", 1280, 720, 900.0, 901.5, 638.5, 361.0, [0.4, -2.5, 0.0006, -0.0001, 1.4, 0.28, -2.3, 1.35]),
]
POINTS_A_SET = 24
ITERATIONS = (cv2.TERM_CRITERIA_COUNT | cv2.TERM_CRITERIA_EPS, 1000, 1e-15)


def main():
    random = np.random.default_rng(20)
    print(f"# made by make_opencv_table.py with OpenCV {cv2.__version__}")
    for model, width, height, fx, fy, cx, cy, coefficients in CALIBRATIONS:
        matrix = np.array([[fx, 0, cx], [0, fy, cy], [0, 0, 1]])
        lens = np.array(coefficients, dtype=float)
        padded = list(coefficients) + [0] * (8 - len(coefficients))
        print("set", model, width, height, fx, fy, cx, cy, *padded)
        pixels = random.uniform([0, 0], [width - 1, height - 1], (POINTS_A_SET, 2))
        depths = random.uniform(0.3, 8.0, POINTS_A_SET)
        points = np.column_stack([(pixels - [cx, cy]) / [fx, fy] * depths[:, None], depths])
        images, _ = cv2.projectPoints(points, np.zeros(3), np.zeros(3), matrix, lens)
        for point, image in zip(points, images[:, 0]):
            print("project", *(f"{x:.17g}" for x in (*point, *image)))
        # Pixels inside 80 % of the image: in the corners of a strong lens the iteration does not converge.
        middle = np.array([width, height]) / 2
        pixels = middle + 0.8 * (random.uniform([0, 0], [width - 1, height - 1], (POINTS_A_SET, 2)) - middle)
        rays = cv2.undistortPointsIter(pixels[:, None], matrix, lens, None, None, ITERATIONS)
        for pixel, ray in zip(pixels, rays[:, 0]):
            print("undistort", *(f"{x:.17g}" for x in (*pixel, *ray)))


if __name__ == "__main__":
    main()
