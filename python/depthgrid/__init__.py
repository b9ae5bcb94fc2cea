"""Lower bounds of the distance from a robot to what depth cameras see, and cannot see.

Images are numpy arrays of H x W, uint16 or float32; capsules are arrays of N x 3 (points), N x 4 (spheres) or N x 7
(capsules) in the world frame, metres. Errors are depthgrid.Error, a ValueError, with the value, the rule and a hint.
"""

from ._core import Camera, Distances, Error, Memory, Rig, SearchEvaluator, sensor_models
from ._core import version as __version__

__all__ = ["Camera", "Distances", "Error", "Memory", "Rig", "SearchEvaluator", "__version__", "sensor_models"]
