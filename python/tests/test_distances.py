"""The module against walls whose distance is known, and against what people do wrong."""

import pathlib
import threading

import numpy as np
import pytest

import depthgrid as dg

WIDTH, HEIGHT = 160, 120
WALL_M = 2.0
#: resolution, the unit of a depth image, and what rounding takes off
TIGHT_M = 0.006


RIG = """{"name": "one", "depth": {"metres_per_unit": 0.001}, "cameras": [
  {"id": "left", "width": 64, "height": 48, "fx": 50, "fy": 50, "cx": 31.5, "cy": 23.5, "sensor": "kinect_v1",
   "T_world_cam": [[0, 0, 1, 1], [-1, 0, 0, 2], [0, -1, 0, 3], [0, 0, 0, 1]], "depth_files": "%d.png"}]}"""


def camera(name: str = "front", **words) -> dg.Camera:
    words = {"T_world_camera": np.eye(4), "sensor": "ideal", **words}
    return dg.Camera(name, width_px=WIDTH, height_px=HEIGHT, fx_px=130, fy_px=130, cx_px=79.5, cy_px=59.5, **words)


def evaluator(cameras=None, **words) -> dg.SearchEvaluator:
    words = {
        "low": (-1, -1, 0.2),
        "high": (1, 1, 3),
        "unobserved": "ignored",
        "outside": "ignored",
        "robot_pockets": "obstacle",
        "v_max_m_s": 2.0,
        "smallest_obstacle_m": 0,
        **words,
    }
    return dg.SearchEvaluator(dg.Rig(cameras or [camera()]), **words)


def wall(depth_m: float = WALL_M) -> np.ndarray:
    return np.full((HEIGHT, WIDTH), round(1000 * depth_m), np.uint16)


def test_distance_to_a_wall():
    cell = evaluator()
    cell.update("front", wall(), time_s=1.0)
    z = np.linspace(1.7, 1.95, 6)
    answer = cell.distances(np.column_stack([0 * z, 0 * z, z]))
    truth = WALL_M - z
    assert np.all(answer.distance_m <= truth + 1e-9)
    assert np.all(answer.distance_m >= truth - TIGHT_M)
    assert answer.states == ["measured"] * 6
    assert answer.cameras == ["front"] * 6
    assert np.allclose(answer.direction_world, [0, 0, 1], atol=1e-6)
    assert np.allclose(answer.nearest_world[:, 2], WALL_M, atol=TIGHT_M)


def test_spheres_and_capsules_are_nearer_by_their_radius():
    cell = evaluator()
    cell.update(0, wall(), time_s=1.0)
    point = cell.distances([[0, 0, 1.8]]).distance_m[0]
    sphere = cell.distances([[0, 0, 1.8, 0.05]]).distance_m[0]
    capsule = cell.distances([[0, 0, 1.5, 0, 0, 1.8, 0.05]])
    assert sphere == pytest.approx(point - 0.05, abs=1e-5)
    assert capsule.distance_m[0] == pytest.approx(point - 0.05, abs=1e-5)
    assert np.allclose(capsule.on_axis_world, [[0, 0, 1.8]])


def test_pixels_lie_where_opencv_puts_them():
    image = wall()
    image[:, 100:110] = 1000
    cells = [evaluator(), evaluator()]
    cells[0].update("front", image, time_s=1.0)
    cells[1].update("front", image[:, ::-1].copy(), time_s=1.0)
    right = cells[0].distances([[0, 0, 1.0]])
    left = cells[1].distances([[0, 0, 1.0]])
    # The principal point is the middle of the image, so what is mirrored is as far.
    assert left.distance_m[0] == pytest.approx(right.distance_m[0], abs=1e-4)
    edge_m = (99.5 - 79.5) / 130  # of pixel 100, towards the middle
    assert edge_m - 0.02 < right.distance_m[0] <= edge_m


def test_all_kinds_of_images_say_the_same():
    def ask(image):
        cell = evaluator()
        cell.update("front", image, time_s=1.0)
        return cell.distances([[0, 0, 1.8]]).distance_m[0]

    padded = np.zeros((HEIGHT, WIDTH + 7), np.uint16)
    padded[:, :WIDTH] = wall()
    read_only = wall()
    read_only.flags.writeable = False
    metres = np.full((HEIGHT, WIDTH), WALL_M, np.float32)
    assert ask(padded[:, :WIDTH]) == ask(wall())
    assert ask(read_only) == ask(wall())
    assert ask(metres) == pytest.approx(ask(wall()), abs=1e-6)


@pytest.mark.parametrize(
    ("image", "words"),
    [
        (np.zeros((HEIGHT, WIDTH)), "uint16"),
        (np.zeros((HEIGHT, WIDTH), np.int16), "uint16"),
        (np.zeros((HEIGHT, WIDTH, 3), np.uint16), "dimensions"),
        (np.zeros((HEIGHT, WIDTH), np.uint16)[::-1], "ascontiguousarray"),
        (np.zeros((HEIGHT, 2 * WIDTH), np.uint16)[:, ::2], "ascontiguousarray"),
        (np.zeros((WIDTH, HEIGHT), np.uint16).T, "ascontiguousarray"),
        (np.zeros((HEIGHT - 1, WIDTH), np.uint16), "shape"),
        (np.zeros((0, WIDTH), np.uint16), "shape"),
        (np.full((HEIGHT, WIDTH), 2000, np.float32), "millimetres"),
    ],
)
def test_images_that_are_refused(image, words):
    with pytest.raises(dg.Error, match=words):
        evaluator().update("front", image, time_s=1.0)


def test_images_come_in_the_order_of_their_times():
    cell = evaluator()
    cell.update("front", wall(1.9), time_s=1.0)
    with pytest.raises(dg.Error, match="order"):
        cell.update("front", wall(), time_s=0.9)
    with pytest.raises(dg.Error, match="time_s"):
        cell.update("front", wall(), time_s=float("nan"))
    assert cell.distances([[0, 0, 1.7]]).distance_m[0] == pytest.approx(0.2, abs=TIGHT_M)


@pytest.mark.parametrize("capsules", [[0, 0, 1], [[0, 0]], [[0] * 5], "words", [["a", 0, 0]], [[[0, 0, 1]]]])
def test_capsules_that_are_refused(capsules):
    with pytest.raises(dg.Error, match="capsules"):
        evaluator().distances(capsules)


def test_no_number_where_nothing_is_known():
    cell = evaluator()
    assert np.isnan(cell.distances([[0, 0, 1.8]]).distance_now_m[0])  # no image yet
    cell.update("front", wall(), time_s=1.0)
    answer = cell.distances([[0, 0, np.nan], [5, 5, 5], [0, 0, 1.2]])
    assert answer.states == ["not_evaluated", "outside", "beyond_rho"]
    assert np.isnan(answer.distance_m[:2]).all()
    assert answer.cameras == [None, None, None]


def test_later_answers_are_shorter():
    cell = evaluator()
    cell.update("front", wall(), time_s=1.0)
    answer = cell.distances([[0, 0, 1.7]], now_s=1.05)
    assert answer.distance_now_m[0] == pytest.approx(answer.distance_m[0] - 2.0 * 0.05, abs=1e-9)
    too_late = cell.distances([[0, 0, 1.7]], now_s=2.0, reasons=True)
    assert not too_late.distance_now_m[0] > 0
    assert len(too_late.reasons) == 1


def test_errors_that_are_stated_make_answers_shorter():
    def ask(**words):
        cell = evaluator([camera(**words)])
        cell.update("front", wall(), time_s=1.0)
        return cell.distances([[0, 0, 1.8]]).distance_m[0]

    assert ask(translation_m=0.03) == pytest.approx(ask() - 0.03, abs=TIGHT_M)
    assert ask(rotation_rad=0.01) == pytest.approx(ask() - 0.01 * WALL_M, abs=TIGHT_M)
    assert ask(half_exposure_s=0.01) == pytest.approx(ask() - 0.01 * 2.0, abs=TIGHT_M)
    assert ask(time_uncertainty_s=0.01) == pytest.approx(ask() - 0.01 * 2.0, abs=TIGHT_M)


def test_what_is_declared_is_checked():
    with pytest.raises(dg.Error, match="unobserved"):
        evaluator(unobserved="free")
    with pytest.raises(dg.Error, match="smallest"):
        evaluator(smallest_obstacle_m=None)
    with pytest.raises(dg.Error, match="sensor"):
        camera(sensor="realsense")
    with pytest.raises(dg.Error, match="T_world_camera"):
        camera(T_world_camera=np.eye(3))
    with pytest.raises(dg.Error, match="front"):
        evaluator([camera(), camera()])
    with pytest.raises(dg.Error, match="margins"):
        evaluator([camera(sensor=None)])
    for word in ("translation_m", "rotation_rad", "half_exposure_s", "time_uncertainty_s", "smallest_obstacle_m"):
        with pytest.raises(dg.Error, match="ideal"):
            camera(sensor=None, **{word: 0.01})
    with pytest.raises(dg.Error, match="no_such"):
        dg.Rig.load(pathlib.Path("no_such.json"))
    assert issubclass(dg.Error, ValueError)


def test_the_robot_is_no_obstacle():
    near, far = np.full((2, HEIGHT, WIDTH), 0, np.float32)
    near[50:70, 70:90], far[50:70, 70:90] = 0.95, 1.1
    image = wall()
    image[50:70, 70:90] = 1000
    asked = [[0, 0, 0.9]]
    cell = evaluator()
    cell.update("front", image, time_s=1.0)
    assert cell.distances(asked).distance_m[0] == pytest.approx(0.1, abs=TIGHT_M)
    cell.update("front", image, time_s=1.1, robot=(near, far, 0.03))
    answer = cell.distances(asked)
    assert answer.distance_m[0] > 0.19
    pixel_m = 1.1 * np.hypot(1, 1) / 130  # its diagonal where the robot ends; half of it, and the filter's one pixel
    assert 0.03 + 0.5 * pixel_m <= answer.blind_m[0] <= 0.03 + 2 * pixel_m
    assert answer.clear_m[0] == pytest.approx(answer.distance_now_m[0] - answer.blind_m[0])


def test_a_memory_knows_what_was_seen_free():
    def ask(memory):
        cell = evaluator(memory=memory, v_max_m_s=0.01)
        cell.update("front", wall(), time_s=1.0)
        before = wall(1.0)  # now something hides the space behind it
        cell.update("front", before, time_s=1.03)
        return cell.distances([[0, 0, 1.5]], reasons=True)

    assert ask(None).distance_m[0] == 0
    remembered = ask(dg.Memory((-1, -1, 0.2), (1, 1, 3), start="unknown"))
    assert remembered.distance_m[0] > 0.3
    with pytest.raises(dg.Error, match="start"):
        dg.Memory((-1, -1, 0), (1, 1, 3), start="full")


def test_a_camera_that_moves():
    cell = evaluator([camera()])
    moved = np.eye(4)
    moved[2, 3] = -0.1
    cell.update("front", wall(), time_s=1.0, T_world_camera=moved)
    assert cell.distances([[0, 0, 1.8]]).distance_m[0] == pytest.approx(0.1, abs=TIGHT_M)


def test_rig_files(tmp_path):
    rig_file = tmp_path / "rig.json"
    rig_file.write_text(RIG)
    rig = dg.Rig.load(rig_file)
    assert [camera.id for camera in rig.cameras] == ["left"]
    assert rig.cameras[0].width_px == 64
    assert np.allclose(rig.cameras[0].T_world_camera[:3, 3], [1, 2, 3])
    assert [camera.id for camera in dg.Rig.parse(RIG).cameras] == ["left"]
    with pytest.raises(dg.Error, match="text"):
        dg.Rig.parse("{")


def test_one_thread_updates_and_one_asks():
    cell = evaluator()
    cell.update("front", wall(), time_s=0.0)
    ends = threading.Event()
    wrong = []

    def bring():
        time_s = 0.0
        while not ends.is_set():
            time_s += 0.03
            cell.update("front", wall(1.9 if round(time_s / 0.03) % 2 else WALL_M), time_s=time_s)

    def ask():
        points = np.tile([[0, 0, 1.7]], (50, 1))
        for _ in range(200):
            distance = cell.distances(points).distance_m
            # Of one image or the other, the same for all points of a call.
            if np.ptp(distance) != 0 or not min(abs(distance[0] - 0.2), abs(distance[0] - 0.3)) < TIGHT_M:
                wrong.append(distance)

    threads = [threading.Thread(target=bring), threading.Thread(target=ask), threading.Thread(target=ask)]
    for thread in threads:
        thread.start()
    threads[1].join()
    threads[2].join()
    ends.set()
    threads[0].join()
    assert not wrong


def test_others_run_while_it_computes():
    cell = evaluator(low=(-3, -3, 0.2), high=(3, 3, 5), unobserved="obstacle")
    noise = np.random.default_rng(1).integers(500, 4000, (HEIGHT, WIDTH)).astype(np.uint16)
    cell.update("front", noise, time_s=1.0)
    points = np.random.default_rng(2).uniform([-0.3, -0.3, 0.3], [0.3, 0.3, 0.5], (20000, 3))
    ends = threading.Event()

    def ask():
        cell.distances(points)
        ends.set()

    thread = threading.Thread(target=ask)
    thread.start()
    turns = 0
    while not ends.wait(0.001):
        turns += 1
    thread.join()
    assert turns > 3


def test_sensor_models():
    models = dg.sensor_models()
    assert next(iter(models)) == "ideal"
    assert "realsense_d435" in models
