"""`ros2 security`: a keystore, and two nodes that talk through it and are heard by nobody else."""

import socket
import subprocess
import sys

import pytest

from .commands import ros2

pytest.importorskip("cryptography", reason="certificates need the package cryptography")

POLICY = """<policy version="0.2.0">
  <enclaves>
    <enclave path="/lab/talker">
      <profiles>
        <profile ns="/" node="talker">
          <topics publish="ALLOW"><topic>chatter</topic></topics>
        </profile>
      </profiles>
    </enclave>
  </enclaves>
</policy>
"""


@pytest.fixture
def keystore(env, tmp_path):
    """Run `ros2 security` beside a keystore with one enclave."""

    def security(*words):
        return ros2("security", *words, env=env, cwd=tmp_path)

    assert security("create_keystore", "keys").status == 0
    assert security("create_enclave", "keys", "/lab/talker").status == 0
    return security


@pytest.mark.slow
def test_a_keystore_is_filled_and_listed(keystore, tmp_path):
    (tmp_path / "policy.xml").write_text(POLICY)
    assert keystore("list_enclaves", "keys").out == "/lab/talker\n"
    assert keystore("create_permission", "keys", "/lab/talker", "policy.xml").status == 0
    for private in (*tmp_path.glob("keys/private/*"), *tmp_path.rglob("key.pem")):
        assert private.stat().st_mode & 0o077 == 0
    made = keystore("generate_artifacts", "-k", "other", "-e", "/a", "/b")
    assert made.status == 0
    assert keystore("list_enclaves", "other").out == "/a\n/b\n"


@pytest.mark.slow
def test_mistakes(keystore, tmp_path):
    (tmp_path / "broken.xml").write_text("<policy")
    for words, fault in (
        (["create_keystore", "keys"], "'keys' is already a keystore"),
        (["create_enclave", "nowhere", "/a"], "'nowhere' is not a valid keystore"),
        (["create_enclave", "keys", "a"], "'a' is not a valid enclave name"),
        (["create_permission", "keys", "/lab/talkr", "broken.xml"], "Did you mean '/lab/talker'?"),
        (["create_permission", "keys", "/lab/talker", "broken.xml"], "broken.xml:1: "),
        (["create_permission", "keys", "/lab/talker", "missing.xml"], "missing.xml"),
    ):
        result = keystore(*words)
        assert (result.status, result.out) == (1, "")
        assert fault in result.err
        assert "Traceback" not in result.err


@pytest.mark.slow
def test_the_certificates_are_of_one_authority(keystore, tmp_path):
    from cryptography import x509

    authority, enclave = (
        x509.load_pem_x509_certificate((tmp_path / "keys" / path).read_bytes())
        for path in ("public/ca.cert.pem", "enclaves/lab/talker/cert.pem")
    )
    enclave.verify_directly_issued_by(authority)


@pytest.mark.slow
def test_the_policy_of_what_runs_is_written(keystore, beside, wait_for, tmp_path):
    beside("import rclpy; rclpy.init(); rclpy.spin(rclpy.create_node('quiet'))")
    wait_for("/quiet/set_parameters")
    assert keystore("generate_policy", "found.xml").status == 0
    text = (tmp_path / "found.xml").read_text()
    assert '<profile ns="/" node="quiet">' in text
    assert "<service>/quiet/set_parameters</service>" in text


TALK = """
import rclpy, sys
from std_msgs.msg import String
rclpy.init()
node = rclpy.create_node("mouth")
publisher = node.create_publisher(String, "secret", 10)
node.create_timer(0.1, lambda: publisher.publish(String(data="psst")))
rclpy.spin(node)
"""


@pytest.mark.slow
def test_who_has_no_key_does_not_hear(keystore, env, tmp_path):
    """Through a router that asks for certificates."""
    keystore("create_enclave", "keys", "/lab/listener")
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        port = probe.getsockname()[1]
    for file in (tmp_path / "keys").rglob("*.json5"):
        file.write_text(file.read_text().replace(":7447", f":{port}"))
    router_env = {**env, "ZENOH_ROUTER_CONFIG_URI": str(tmp_path / "keys" / "router" / "router.json5")}
    inside = [
        {**env, "ZENOH_SESSION_CONFIG_URI": str(tmp_path / "keys" / "enclaves" / "lab" / name / "session.json5")}
        for name in ("talker", "listener")
    ]
    running = []
    try:
        router = "from daidalos.nodes.rmw_zenoh_cpp.rmw_zenohd import main; main()"
        running.append(subprocess.Popen([sys.executable, "-u", "-c", router], env=router_env, stdout=subprocess.PIPE))
        assert b"Zenoh router" in running[0].stdout.readline()
        running.append(subprocess.Popen([sys.executable, "-c", TALK], env=inside[0]))
        received = ros2("topic", "echo", "--once", "/secret", "std_msgs/msg/String", env=inside[1])
        assert received.out == "data: psst\n---\n"
        deaf = ros2("topic", "echo", "--once", "--timeout", "2", "/secret", "std_msgs/msg/String", env=env)
        assert "psst" not in deaf.out
    finally:
        for process in running:
            process.kill()
            process.communicate()
