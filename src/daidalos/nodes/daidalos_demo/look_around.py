"""`look_around`: rotates the robot once at startup, so that the map covers the area behind it."""

from __future__ import annotations

from daidalos.nodes.runner import run_program


def main() -> int:
    """Run the program."""

    def body() -> None:
        import rclpy
        from rclpy.executors import SingleThreadedExecutor

        from daidalos.nodes.daidalos_demo._robot import Robot

        rclpy.init()
        node = rclpy.create_node("look_around")
        robot = Robot(node)

        async def turn() -> None:
            await robot.until_ready()
            await robot.look_around()

        executor = SingleThreadedExecutor()
        executor.add_node(node)
        executor.spin_until_future_complete(executor.create_task(turn))
        node.destroy_node()

    return run_program(body)
