"""Takes the README's picture of the studio: a real page of a real demonstration, in Chromium.

uv run python tools/take_picture.py docs/images/studio.png
"""

import sys
from pathlib import Path

TESTS = Path(__file__).resolve().parent.parent / "tests"
DOMAIN = 96
SIZE = (1600, 900)
GOAL = ((2.2, -1.1), (2.7, -0.9))
UNDERWAY = "Math.hypot(daidalos.state().robotPose.x, daidalos.state().robotPose.y) > 0.9"


def main(picture: Path) -> None:
    """Run the demonstration, send the robot on its way and write the picture."""
    sys.path.insert(0, str(TESTS))
    from browser.cdp import Chromium
    from end_to_end.processes import DAIDALOS, Command
    from end_to_end.test_demo_in_the_browser import drag_goal

    with Command(*DAIDALOS, "demo", "--no-browser", domain=DOMAIN) as demo, Chromium(*SIZE) as page:
        address = demo.wait_for_line("studio: http://").split("studio: ")[1]
        demo.wait_for_line("look_around.*finished")
        page.open(f"{address}?quality=best")
        page.wait_for("daidalos.state().scanPoints > 500 && daidalos.state().robotPose", timeout=60)
        drag_goal(page, *GOAL)
        page.wait_for(UNDERWAY, timeout=60)
        page.screenshot(picture)


if __name__ == "__main__":
    main(Path(sys.argv[1]))
