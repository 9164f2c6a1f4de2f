"""A robot of scripts for trees."""

from daidalos.navigation.trees.services import Outcome

SUCCESS = Outcome(True)
FAILURE = Outcome(False, {}, "UNKNOWN", "scripted")


class ScriptedTask:
    """Runs for some ticks and then ends as told."""

    def __init__(self, robot, name, ticks, outcome):
        self.robot, self.name, self.ticks, self.outcome = robot, name, ticks, outcome

    def poll(self):
        self.ticks -= 1
        return self.outcome if self.ticks < 0 else None

    def update(self, goal):
        self.robot.log.append(f"update {self.name}")
        self.robot.goals[self.name] = dict(goal)

    def halt(self):
        self.robot.log.append(f"halt {self.name}")


class ScriptedRobot:
    """Ends each task as a script says: name -> list of (ticks, outcome), the last one repeated."""

    def __init__(self, **scripts):
        self.scripts = scripts
        self.time = 0.0
        self.log = []
        self.goals = {}

    def now(self):
        return self.time

    def start(self, node, goal):
        action = node.__name__
        self.log.append(action)
        self.goals[action] = dict(goal)
        script = self.scripts.get(action, [(0, SUCCESS)])
        ticks, outcome = script.pop(0) if len(script) > 1 else script[0]
        return ScriptedTask(self, action, ticks, outcome)

    def run(self, tree, ticks=1, step=0.1):
        """Tick a tree some times, or until it ends; returns its status."""
        for _ in range(ticks):
            status = tree.tick()
            self.time += step
            if status.name != "RUNNING":
                break
        return status.name


def document(inside, **attributes):
    """XML of one tree."""
    more = "".join(f' {key}="{value}"' for key, value in attributes.items())
    return f'<root BTCPP_format="4"{more}><BehaviorTree ID="Main">{inside}</BehaviorTree></root>'
