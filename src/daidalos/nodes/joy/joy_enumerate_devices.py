"""`joy_enumerate_devices`: lists the game pads of this machine."""

from __future__ import annotations

from daidalos.nodes.joystick import FOLDER, device_name, devices


def main() -> int:
    """List them."""
    found = devices()
    if not found:
        print(f"No game pads: there is no {FOLDER}/js*.")
        return 0
    print("ID : Device : Name")
    for place, path in enumerate(found):
        print(f"{place:2d} : {path} : {device_name(path)}")
    return 0
