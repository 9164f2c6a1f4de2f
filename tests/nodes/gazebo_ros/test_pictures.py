"""Which pictures are drawn while a simulation is late."""

from collections import Counter

from daidalos.nodes.gazebo_ros._pictures import MAX_LAG_NS, PictureBudget

PERIOD_NS = 33_000_000


def drawn(cameras, capacity, rounds, stop=()):
    """Return how many pictures each camera drew where `capacity` of them fit into each period."""
    used, counts = 0, Counter()
    budget = PictureBudget(lambda: MAX_LAG_NS + 1 if used >= capacity else 0)
    for number in range(rounds):
        used = 0
        for camera in cameras:
            if number >= rounds // 2 and camera in stop:
                continue
            if budget.allows(camera, number * PERIOD_NS):
                used += 1
                counts[camera] += 1
    return counts


def test_all_pictures_are_drawn_in_time():
    assert drawn("abc", 3, 10) == {"a": 10, "b": 10, "c": 10}


def test_cameras_take_turns_when_it_is_late():
    counts = drawn("abcdefghij", 3, 100)
    assert counts.total() >= 240
    assert max(counts.values()) - min(counts.values()) <= 3


def test_a_camera_that_is_gone_is_not_waited_for():
    counts = drawn("abcd", 1, 400, stop="d")
    assert counts["a"] + counts["b"] + counts["c"] >= 300
    assert counts["d"] >= 40


def test_time_that_was_set_back_is_no_obstacle():
    lag = [MAX_LAG_NS + 1]
    budget = PictureBudget(lambda: lag[0])
    assert not budget.allows("a", 9 * PERIOD_NS)
    lag[0] = 0
    assert budget.allows("b", 0)
