from daidalos.simulation.schedule import Schedule


class Fake:
    def __init__(self, period):
        self.period = period


def run(schedule, until_ns, step_ns=1_000_000):
    """Step through time and return who was due when."""
    now, fired = 0, []
    while now < until_ns:
        now += step_ns
        fired += [(now, component) for component in schedule.due(now)]
    return fired


def test_rates_do_not_drift():
    schedule, lidar = Schedule(), Fake(1 / 15)
    schedule.add(lidar, 0)
    times = [now for now, _ in run(schedule, 60_000_000_000)]
    assert len(times) == 900
    assert all(0 <= now - (i + 1) * 1e9 / 15 < 1e6 + 1 for i, now in enumerate(times))


def test_who_is_due_first_comes_first_and_ties_go_by_the_order_of_adding():
    schedule, first, second, always = Schedule(), Fake(0.01), Fake(0.01), Fake(0.0)
    for component in (first, second, always):
        schedule.add(component, 0)
    fired = run(schedule, 10_000_000)
    assert [c for now, c in fired if now == 10_000_000] == [always, first, second]
    assert sum(c is always for _, c in fired) == 10


def test_who_starts_late_is_due_after_its_own_period():
    schedule, late = Schedule(), Fake(0.01)
    schedule.add(late, 5_000_000)
    assert schedule.next_due() == 15_000_000
    schedule.remove([late])
    assert schedule.next_due() is None


def test_what_is_faster_than_the_steps_is_due_once_a_step():
    schedule, fast = Schedule(), Fake(1e-7)
    schedule.add(fast, 0)
    assert [now for now, _ in run(schedule, 5_000_000)] == [1_000_000 * i for i in range(1, 6)]


def test_clocks_can_be_saved_and_set_back():
    schedule, component = Schedule(), Fake(0.01)
    schedule.add(component, 0)
    saved = schedule.save()
    run(schedule, 30_000_000)
    schedule.restore(saved)
    assert schedule.next_due() == 10_000_000
    schedule.restart(7_000_000)
    assert schedule.next_due() == 17_000_000
