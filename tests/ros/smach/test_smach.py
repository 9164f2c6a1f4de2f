"""State machines, sequences, iterators and concurrences."""

import pickle
import threading

import pytest
import smach
from smach import CBState, Concurrence, Iterator, Sequence, State, StateMachine, UserData


@pytest.fixture(autouse=True)
def logged():
    """What is logged: [(level, message)]."""
    messages: list[tuple[str, str]] = []
    smach.set_loggers(*(lambda text, level=level: messages.append((level, text)) for level in ("i", "w", "d", "e")))
    smach.set_shutdown_check(lambda: False)
    return messages


def returning(outcome, **keywords):
    return CBState(lambda ud: outcome, outcomes=[outcome, "other"], **keywords)


class Waiting(State):
    """Ends on request."""

    def __init__(self):
        super().__init__(outcomes=["preempted", "late"])
        self.entered = threading.Event()
        self.asked = threading.Event()

    def execute(self, ud):
        self.entered.set()
        if not self.asked.wait(10.0):
            return "late"
        self.service_preempt()
        return "preempted"

    def request_preempt(self):
        super().request_preempt()
        self.asked.set()


def test_transitions_lead_from_state_to_state_and_out():
    machine = StateMachine(["done", "other"])
    seen = []
    machine.register_start_cb(lambda ud, states: seen.append(("start", states)))
    machine.register_transition_cb(lambda ud, states, more: seen.append((more, states)), ["to"])
    machine.register_termination_cb(lambda ud, states, outcome: seen.append((outcome, states)))
    with machine:
        StateMachine.add("FIRST", returning("go"), {"go": "SECOND"})
        StateMachine.add("SECOND", returning("stop"), {"stop": "done"})
    assert machine.execute() == "done"
    assert seen == [("start", ["FIRST"]), ("to", ["SECOND"]), ("done", ["SECOND"])]
    assert set(machine.get_internal_edges()) >= {("go", "FIRST", "SECOND"), ("stop", "SECOND", "done")}


def test_userdata_are_remapped_and_copied_in_and_out():
    inner = StateMachine(["done"], input_keys=["given"], output_keys=["made"])

    @smach.cb_interface(outcomes=["done"], input_keys=["a"], output_keys=["b"])
    def double(ud):
        ud.b = 2 * ud.a
        return "done"

    with inner:
        StateMachine.add("DOUBLE", CBState(double), remapping={"a": "given", "b": "made"})
    outer = StateMachine(["done"])
    outer.userdata.number = 21
    with outer:
        StateMachine.add("INNER", inner, remapping={"given": "number"})
    assert outer.execute() == "done"
    assert outer.userdata.made == 42


def test_undeclared_userdata_can_not_be_read_and_are_not_written(logged):
    class Curious(State):
        def execute(self, ud):
            ud.secret = 1
            return "x" if "secret" in ud else str(ud.secret)

    machine = StateMachine(["x"])
    with machine:
        StateMachine.add("CURIOUS", Curious(outcomes=["x"]))
    with pytest.raises(smach.InvalidUserCodeError, match="'secret'"):
        machine.execute()
    assert any("Writing to SMACH userdata key 'secret'" in text for level, text in logged if level == "e")
    assert "secret" not in machine.userdata


def test_input_is_read_only():
    class Box:
        content = 1

    machine = StateMachine(["done"])
    machine.userdata.box = Box()

    def change(ud):
        with pytest.raises(TypeError, match="read-only"):
            ud.box.content = 2
        return "done"

    with machine:
        StateMachine.add("CHANGE", CBState(change, outcomes=["done"], input_keys=["box"]))
    assert machine.execute() == "done"


def test_faults_are_named(logged):
    machine = StateMachine(["done"])
    with machine:
        StateMachine.add("A", returning("go"), {"go": "NOWHERE"})
        with pytest.raises(smach.InvalidTransitionError, match="'gone' on state 'B'"):
            StateMachine.add("B", returning("go"), {"gone": "A"})
        with pytest.raises(smach.InvalidStateError, match="already being used"):
            StateMachine.add("A", returning("go"))
    with pytest.raises(smach.InvalidTransitionError, match="NOWHERE"):
        machine.check_consistency()
    assert machine.execute() is None
    with pytest.raises(smach.InvalidStateError, match="no container is opened"):
        StateMachine.add("C", returning("go"))
    with pytest.raises(KeyError):
        machine["C"]


def test_an_exception_in_a_state_is_an_error_of_the_users_code():
    machine = StateMachine(["done"])
    with machine:
        StateMachine.add("BAD", CBState(lambda ud: 1 / 0, outcomes=["done"]))
    with pytest.raises(smach.InvalidUserCodeError, match="ZeroDivisionError"):
        machine.execute()
    assert not machine.is_running()


def test_a_preempted_machine_ends_with_its_state():
    machine, waiting = StateMachine(["preempted", "late"]), Waiting()
    with machine:
        StateMachine.add("WAIT", waiting)
    outcomes = []
    thread = threading.Thread(target=lambda: outcomes.append(machine.execute()))
    thread.start()
    assert waiting.entered.wait(10.0)
    machine.request_preempt()
    thread.join()
    assert outcomes == ["preempted"]
    assert not machine.preempt_requested()


def test_states_that_are_added_automatically_follow_each_other():
    sequence = Sequence(["go", "other"], "go")
    with sequence:
        for label in "ABC":
            Sequence.add(label, returning("go"))
    assert ("go", "A", "B") in sequence.get_internal_edges()
    assert sequence.execute() == "go"
    machine = StateMachine(["go", "other"])
    with machine.opened():
        StateMachine.add_auto("A", returning("go"), ["go"])
        StateMachine.add("B", returning("go"))
    assert ("go", "A", "B") in machine.get_internal_edges()


def test_an_iterator_goes_through_its_items():
    seen = []

    def take(ud):
        seen.append(ud.it_data)
        return "enough" if ud.it_data == 3 else "more"

    iterator = Iterator(["found", "exhausted"], [], [], it=range(10))
    state = CBState(take, outcomes=["more", "enough"], input_keys=["it_data"])
    with iterator:
        Iterator.set_contained_state("TAKE", state, loop_outcomes=["more"], final_outcome_map={"enough": "found"})
    assert iterator.execute() == "found"
    assert seen == [0, 1, 2, 3]
    with iterator:
        Iterator.set_iteritems(lambda: [7])
    assert iterator.execute() == "exhausted"


def test_a_concurrence_maps_outcomes():
    both = Concurrence(["good", "bad"], "bad", outcome_map={"good": {"A": "one", "B": "two"}})
    with both:
        Concurrence.add("A", returning("one"))
        Concurrence.add("B", returning("two"))
    assert both.execute() == "good"
    chosen = Concurrence(["good", "bad"], "bad", outcome_cb=lambda found: "good" if found["A"] == "one" else None)
    with chosen:
        Concurrence.add("A", returning("one"))
    assert chosen.execute() == "good"
    with pytest.raises(smach.InvalidStateError, match="'nothing' is unregistered"):
        Concurrence(["good"], "nothing")


def test_a_concurrence_preempts_the_others():
    waiting = Waiting()
    race = Concurrence(["won"], "won", child_termination_cb=lambda outcomes: True)
    with race:
        Concurrence.add("SLOW", waiting)
        Concurrence.add("FAST", returning("one"))
    assert race.execute() == "won"
    assert waiting.asked.is_set()


def test_an_exception_in_a_concurrent_state_ends_the_others():
    waiting = Waiting()
    both = Concurrence(["done"], "done")
    with both:
        Concurrence.add("WAIT", waiting)
        Concurrence.add("BAD", CBState(lambda ud: 1 / 0, outcomes=["done"]))
    with pytest.raises(smach.InvalidStateError, match="raised an exception"):
        both.execute()
    assert waiting.asked.is_set()


def test_userdata_merge_extract_and_pickle():
    data = UserData()
    data.a = [1]
    extracted = data.extract(["a"], {"b": "a"})
    assert extracted.b == [1]
    data.merge(extracted, ["b"], {"b": "c"})
    assert sorted(data.keys()) == ["a", "c"]
    assert pickle.loads(pickle.dumps(data)).c == [1]
    with pytest.raises(KeyError):
        _ = data.missing
