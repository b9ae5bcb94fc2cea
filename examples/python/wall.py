"""How far two points are from a wall that one camera sees: python wall.py"""

import numpy as np

import depthgrid

camera = depthgrid.Camera(
    "front",
    width_px=640,
    height_px=480,
    fx_px=525,
    fy_px=525,
    cx_px=319.5,
    cy_px=239.5,
    T_world_camera=np.eye(4),
    sensor="ideal",
)
cell = depthgrid.SearchEvaluator(
    depthgrid.Rig([camera]),
    low=(-1, -1, 0.2),
    high=(1, 1, 3),
    unobserved="obstacle",
    outside="ignored",
    robot_pockets="obstacle",
    v_max_m_s=2.0,
    smallest_obstacle_m=0,
)
cell.update("front", np.full((480, 640), 2000, np.uint16), time_s=0.0)  # a wall 2 m away, in millimetres
answer = cell.distances([[0, 0, 1.7], [0, 0, 2.1]], now_s=0.01, reasons=True)
for distance_m, state, reason in zip(answer.distance_now_m, answer.states, answer.reasons):
    print(f"{distance_m:.3f} m, {state}: {reason}")
