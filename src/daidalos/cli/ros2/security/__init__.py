"""`ros2 security`."""

from typing import ClassVar

from daidalos.cli.ros2.verbs import VerbCommand


class SecurityCommand(VerbCommand):
    """Various security related sub-commands."""

    group = "sros2.verb"
    verbs: ClassVar = {
        "create_enclave": "Create enclave",
        "create_keystore": "Create keystore",
        "create_permission": "Create permission",
        "generate_artifacts": "Generate keys and permission files from a list of identities and policy files",
        "generate_policy": "Generate XML policy file from ROS graph data",
        "list_enclaves": "List enclaves in keystore",
    }
