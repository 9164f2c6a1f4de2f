"""A robot of scripts for trees."""

import numpy as np
from geometry_msgs.msg import PoseStamped
from nav_msgs.msg import Path

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

    def feedback(self):
        return self.robot.feedback

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
        self.pose = np.zeros(3)
        self.speed = 0.0
        self.heard = {}
        self.transforms = set()
        self.feedback = {}

    def robot_pose(self, frame="", base=""):
        return self.pose

    def robot_pose_stamped(self, frame="", base=""):
        return None if self.pose is None else stamped(*self.pose[:2])

    def pose_in(self, pose, frame=""):
        return np.array([pose.pose.position.x, pose.pose.position.y, 0.0])

    def can_transform(self, target, source):
        return (target, source) in self.transforms

    def velocity(self):
        return np.array([self.speed, 0.0, 0.0])

    def latest(self, topic, kind, *, latched=False):
        return self.heard.get(topic)

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


def stamped(x, y=0.0, sec=0):
    """A pose on the map."""
    pose = PoseStamped()
    pose.header.frame_id, pose.header.stamp.sec = "map", sec
    pose.pose.position.x, pose.pose.position.y = float(x), float(y)
    return pose


def path_of(*places):
    """A path over places on the map, on its x axis where they are numbers."""
    path = Path(poses=[stamped(*place) if isinstance(place, tuple) else stamped(place) for place in places])
    path.header.frame_id = "map"
    return path
