"""Sends the robot from place to place by Nav2's action."""

import rclpy
from nav2_msgs.action import NavigateToPose
from rclpy.action import ActionClient
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node

PLACES = [(1.2, -1.6), (-0.8, -2.0), (-0.8, 1.2), (1.2, 1.6)]


class Patrol(Node):
    def __init__(self):
        super().__init__("patrol")
        self.navigator = ActionClient(self, NavigateToPose, "navigate_to_pose")

    async def run(self, rounds):
        for _ in range(rounds):
            for x, y in PLACES:
                reached = await self.drive(x, y)
                self.get_logger().info(f"({x}, {y}): {'reached' if reached else 'not reached'}")

    async def drive(self, x, y):
        goal = NavigateToPose.Goal()
        goal.pose.header.frame_id = "map"
        goal.pose.pose.position.x = x
        goal.pose.pose.position.y = y
        goal.pose.pose.orientation.w = 1.0
        accepted = await self.navigator.send_goal_async(goal)
        if not accepted.accepted:
            return False
        outcome = await accepted.get_result_async()
        return outcome.result.error_code == NavigateToPose.Result.NONE


def main():
    try:
        with rclpy.init():
            node = Patrol()
            rounds = node.declare_parameter("rounds", 1).value
            if not node.navigator.wait_for_server(timeout_sec=30.0):
                raise SystemExit("there is no navigator; start `daidalos demo` first")
            executor = rclpy.get_global_executor()
            executor.add_node(node)
            executor.spin_until_future_complete(executor.create_task(node.run, rounds))
    except (KeyboardInterrupt, ExternalShutdownException):
        pass


if __name__ == "__main__":
    main()
