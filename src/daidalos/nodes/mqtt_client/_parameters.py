"""Parameters of `mqtt_client`."""

from __future__ import annotations

from dataclasses import dataclass

from daidalos.common.parameters import Parameters, group, parameter

_POLICIES = ("system_default", "reliable", "best_effort")
_DURABILITIES = ("system_default", "volatile", "transient_local")


@dataclass(frozen=True)
class BrokerParameters(Parameters):
    """Where the broker is, and how one logs in."""

    host: str = parameter("localhost", "Host of the broker.", not_empty=True)
    port: int = parameter(1883, "Port of the broker.", minimum=1, maximum=65535)
    user: str = parameter("", "User name; anonymous where empty.")
    password: str = parameter("", "Password.", name="pass")
    tls: bool = parameter(False, "Whether the connection is encrypted.", name="tls.enabled")
    ca_certificate: str = parameter(
        "", "File of the trusted certificates, relative to ROS_HOME; the system's where empty.",
        name="tls.ca_certificate",
    )  # fmt: skip


@dataclass(frozen=True)
class ClientParameters(Parameters):
    """The client's identity, session, last will and certificates."""

    id: str = parameter("", "Unique name of the client; the broker chooses one where empty.")
    buffer_size: int = parameter(
        0, "Number of messages kept while there is no broker; it needs an `id`.", minimum=0, name="buffer.size"
    )
    buffer_directory: str = parameter(
        "buffer", "Folder, relative to ROS_HOME, in which they are kept.", not_empty=True, name="buffer.directory"
    )
    will_topic: str = parameter("", "Topic of the last will; none where empty.", name="last_will.topic")
    will_message: str = parameter("offline", "Last will.", name="last_will.message")
    will_qos: int = parameter(0, "Quality of service of the last will.", minimum=0, maximum=2, name="last_will.qos")
    will_retained: bool = parameter(False, "Whether the broker retains the last will.", name="last_will.retained")
    clean_session: bool = parameter(True, "Whether the broker forgets the client when it leaves.")
    keep_alive_interval: float = parameter(
        60.0, "Time without messages after which the broker is asked for a sign of life.",
        unit="s", minimum=1.0, maximum=65535.0,
    )  # fmt: skip
    max_inflight: int = parameter(
        65535, "Number of messages that may await their confirmation at a time.", minimum=1, maximum=65535
    )
    certificate: str = parameter(
        "", "File of the client's certificate, relative to ROS_HOME; none where empty.", name="tls.certificate"
    )
    key: str = parameter("", "File of that certificate's key, relative to ROS_HOME.", name="tls.key")
    key_password: str = parameter("", "Password of the key.", name="tls.password")
    tls_version: int = parameter(
        0, "Version of TLS: 0 any, 1 1.0, 2 1.1, 3 1.2.", choices=(0, 1, 2, 3), name="tls.version"
    )
    verify: bool = parameter(
        True, "Whether the certificate must have been issued for the broker's host.", name="tls.verify"
    )
    alpn_protos: tuple[str, ...] = parameter((), "Protocols of ALPN.", name="tls.alpn_protos")
    server_cert_auth: bool = parameter(
        True, "Whether the broker's certificate must be trusted.", name="tls.server_cert_auth"
    )


@dataclass(frozen=True)
class MqttClientParameters(Parameters):
    """Parameters of ``mqtt_client``, beside those of its bridges."""

    broker: BrokerParameters = group(BrokerParameters)
    client: ClientParameters = group(ClientParameters)
    ros_topics: tuple[str, ...] = parameter(
        (), "ROS topics to send to the broker.", unique=True, name="bridge.ros2mqtt.ros_topics"
    )
    mqtt_topics: tuple[str, ...] = parameter(
        (), "MQTT topics to publish as ROS topics.", unique=True, name="bridge.mqtt2ros.mqtt_topics"
    )


@dataclass(frozen=True)
class Ros2MqttParameters(Parameters):
    """Parameters of a bridge from a ROS topic to an MQTT topic, below ``bridge.ros2mqtt.<ros topic>``."""

    mqtt_topic: str = parameter("", "MQTT topic; the bridge is left out where empty.")
    primitive: bool = parameter(False, "Whether the message's only value is sent as text.")
    json: bool = parameter(False, "Whether messages are sent as JSON; it needs `ros_type`.")
    ros_type: str = parameter("", "Type of the messages; that of the topic's publishers where empty.")
    inject_timestamp: bool = parameter(False, "Whether the time of sending precedes each message.")
    queue_size: int = parameter(1, "Depth of the subscription.", minimum=1, name="advanced.ros.queue_size")
    reliability: str = parameter(
        "auto", "Reliability of the subscription; that of the publishers with auto.",
        choices=("auto", *_POLICIES), name="advanced.ros.qos.reliability",
    )  # fmt: skip
    durability: str = parameter(
        "auto", "Durability of the subscription; that of the publishers with auto.",
        choices=("auto", *_DURABILITIES), name="advanced.ros.qos.durability",
    )  # fmt: skip
    qos: int = parameter(0, "MQTT quality of service.", minimum=0, maximum=2, name="advanced.mqtt.qos")
    retained: bool = parameter(False, "Whether the broker retains the newest message.", name="advanced.mqtt.retained")


@dataclass(frozen=True)
class Mqtt2RosParameters(Parameters):
    """Parameters of a bridge from an MQTT topic to a ROS topic, below ``bridge.mqtt2ros.<MQTT topic>``."""

    ros_topic: str = parameter("", "ROS topic; the bridge is left out where empty.")
    primitive: bool = parameter(False, "Whether messages are text of a single value.")
    json: bool = parameter(False, "Whether messages are JSON; it needs `ros_type`.")
    ros_type: str = parameter("", "Type of the messages; the one that the sender announces where empty.")
    queue_size: int = parameter(1, "Depth of the publisher.", minimum=1, name="advanced.ros.queue_size")
    latched: bool = parameter(
        False, "Whether late subscribers get the newest message too.", name="advanced.ros.latched"
    )
    reliability: str = parameter(
        "system_default", "Reliability of the publisher.", choices=_POLICIES, name="advanced.ros.qos.reliability"
    )
    durability: str = parameter(
        "system_default", "Durability of the publisher.", choices=_DURABILITIES, name="advanced.ros.qos.durability"
    )
    qos: int = parameter(0, "MQTT quality of service.", minimum=0, maximum=2, name="advanced.mqtt.qos")
