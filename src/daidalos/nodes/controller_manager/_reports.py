"""Messages about the state of controllers and hardware."""

from __future__ import annotations

from typing import Any

from daidalos.control.component import ACTIVE, FINALIZED, INACTIVE, UNCONFIGURED
from daidalos.control.manager import ControllerManager


def controller_message(manager: ControllerManager, name: str) -> Any:
    """Return a controller as a ``controller_manager_msgs/msg/ControllerState``."""
    from controller_manager_msgs.msg import ChainConnection, ControllerState

    loaded = manager.controllers[name]
    controller = loaded.controller
    message = ControllerState(name=name, state=loaded.state, type=loaded.type_name, is_chainable=loaded.kind.chainable)
    if controller is None:
        return message
    commands, states = list(controller.command_names), list(controller.state_names)
    message.update_rate = round(controller.context.update_rate)
    message.claimed_interfaces = commands if loaded.state == ACTIVE else []
    message.required_command_interfaces, message.required_state_interfaces = commands, states
    message.is_chained = controller.chained
    message.exported_state_interfaces = list(loaded.exported.names)
    message.reference_interfaces = list(loaded.references.names)
    message.chain_connections = [
        ChainConnection(name=other, reference_interfaces=[one.removeprefix(f"{other}/") for one in names])
        for other, names in manager.chained_to(name).items()
    ]
    return message


def component_message(manager: ControllerManager, name: str) -> Any:
    """Return hardware as a ``controller_manager_msgs/msg/HardwareComponentState``."""
    from controller_manager_msgs.msg import HardwareComponentState, HardwareInterface

    component = manager.components[name]
    info = component.hardware.info
    types = {
        f"{part.name}/{one.name}": one.data_type for part in info.components for one in (*part.commands, *part.states)
    }
    return HardwareComponentState(
        name=name,
        type=info.type,
        is_async=info.is_async,
        rw_rate=round(info.rw_rate or manager.update_rate),
        plugin_name=info.plugin,
        state=state_message(component.state),
        command_interfaces=[
            HardwareInterface(
                name=one,
                data_type=types.get(one, "double"),
                is_available=component.takes_commands,
                is_claimed=bool(manager.claimed(one)),
            )
            for one in component.hardware.commands.names
        ],
        state_interfaces=[
            HardwareInterface(
                name=one, data_type=types.get(one, "double"), is_available=component.tells_states, is_claimed=False
            )
            for one in component.hardware.states.names
        ],
    )


def interface_messages(manager: ControllerManager) -> tuple[list[Any], list[Any]]:
    """Return all command and state interfaces, of hardware and of controllers that others may command."""
    from controller_manager_msgs.msg import HardwareInterface

    components = [component_message(manager, name) for name in manager.components]
    commands = [one for component in components for one in component.command_interfaces]
    states = [one for component in components for one in component.state_interfaces]
    for loaded in manager.controllers.values():
        active = loaded.state == ACTIVE
        commands += [
            HardwareInterface(name=one, data_type="double", is_available=active, is_claimed=bool(manager.claimed(one)))
            for one in loaded.references.names
        ]
        states += [
            HardwareInterface(name=one, data_type="double", is_available=active) for one in loaded.exported.names
        ]
    return commands, states


def activity_message(manager: ControllerManager, stamp: Any) -> Any:
    """Return the states of everything as a ``controller_manager_msgs/msg/ControllerManagerActivity``."""
    from controller_manager_msgs.msg import ControllerManagerActivity, NamedLifecycleState
    from std_msgs.msg import Header

    return ControllerManagerActivity(
        header=Header(stamp=stamp),
        controllers=[
            NamedLifecycleState(name=name, state=state_message(one.state)) for name, one in manager.controllers.items()
        ],
        hardware_components=[
            NamedLifecycleState(name=name, state=state_message(one.state)) for name, one in manager.components.items()
        ],
    )


def state_message(state: str) -> Any:
    """Return a state as a ``lifecycle_msgs/msg/State``."""
    from lifecycle_msgs.msg import State

    numbers = {
        UNCONFIGURED: State.PRIMARY_STATE_UNCONFIGURED,
        INACTIVE: State.PRIMARY_STATE_INACTIVE,
        ACTIVE: State.PRIMARY_STATE_ACTIVE,
        FINALIZED: State.PRIMARY_STATE_FINALIZED,
    }
    return State(id=numbers[state], label=state)
