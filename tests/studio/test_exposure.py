"""The server beyond loopback: token, cookie, encryption, and other users of the machine."""

import asyncio
import os
import ssl
import subprocess
import sys

import aiohttp
import pytest
from yarl import URL

from daidalos.studio.access import cookie_name
from daidalos.studio.server import StudioServer
from studio.foxglove_client import SUBPROTOCOL, FoxgloveClient
from studio.memory_source import MemorySource

HTML = {"Accept": "text/html"}


@pytest.fixture
def exposed(tmp_path):
    with StudioServer(MemorySource(), port=0, hosts=("0.0.0.0",), static=tmp_path) as server:
        yield server


def test_loopback_asks_for_no_token(tmp_path):
    with StudioServer(MemorySource(), port=0, static=tmp_path) as server:
        assert server.url == f"http://localhost:{server.port}/"
        assert server.remote_url is None


def test_addresses_hold_a_token_that_no_other_server_has(exposed, tmp_path):
    token = URL(exposed.url).query["token"]
    assert len(token) >= 32
    assert URL(exposed.remote_url).query["token"] == token
    assert URL(exposed.remote_url).host not in ("localhost", "127.0.0.1", "0.0.0.0")
    other = StudioServer(MemorySource(), port=0, hosts=("0.0.0.0",), static=tmp_path)
    assert URL(other.url).query["token"] != token


@pytest.mark.parametrize("path", ["/", "/index.html", "/extensions.json", "/arrangement.json", "/extensions/a/b/c.js"])
def test_nothing_is_served_without_the_token(exposed, path):
    async def run():
        base = f"http://127.0.0.1:{exposed.port}"
        async with aiohttp.ClientSession() as http:
            for headers in ({}, {"Authorization": "Bearer wrong"}, {"Cookie": f"{cookie_name(exposed.port)}=wrong"}):
                async with http.get(base + path, headers=headers) as response:
                    assert response.status == 401
            with pytest.raises(aiohttp.WSServerHandshakeError) as caught:
                await http.ws_connect(base, protocols=[SUBPROTOCOL])
            assert caught.value.status == 401

    asyncio.run(run())


def test_the_first_visit_leaves_a_cookie_with_which_the_page_connects(exposed):
    async def run():
        address = URL(exposed.url).with_host("127.0.0.1")
        jar = aiohttp.CookieJar(unsafe=True)
        async with aiohttp.ClientSession(cookie_jar=jar) as http:
            asked = address.update_query(panel="plot")
            async with http.get(asked, headers=HTML, allow_redirects=False) as response:
                assert response.status == 303
                assert response.headers["Location"] == "/?panel=plot"
                cookie = response.headers["Set-Cookie"]
                assert "HttpOnly" in cookie
                assert "SameSite=Strict" in cookie
            async with http.get(asked, headers=HTML) as response:
                assert response.status == 200
                assert response.url.query == {"panel": "plot"}
            old = address.update_query(token="of another start")
            async with http.get(old, headers=HTML, allow_redirects=False) as response:
                assert response.status == 303
                assert "Set-Cookie" not in response.headers
            own = f"http://127.0.0.1:{exposed.port}"
            async with http.ws_connect(own, protocols=[SUBPROTOCOL], origin=own) as socket:
                assert "serverInfo" in await socket.receive_str()
            with pytest.raises(aiohttp.WSServerHandshakeError) as caught:
                await http.ws_connect(own, protocols=[SUBPROTOCOL], origin="http://203.0.113.66")
            assert caught.value.status == 403

    asyncio.run(run())


def test_programs_send_the_token_in_the_address_or_in_a_header(exposed):
    async def run():
        address = URL(exposed.url).with_host("127.0.0.1")
        async with FoxgloveClient(str(address)) as client:
            assert client.info["name"] == "daidalos"
        bearer = {"Authorization": f"Bearer {address.query['token']}"}
        async with (
            aiohttp.ClientSession(headers=bearer) as http,
            http.ws_connect(address.with_query(None), protocols=[SUBPROTOCOL], origin="file://") as socket,
        ):
            assert "serverInfo" in await socket.receive_str()

    asyncio.run(run())


def test_a_certificate_encrypts_page_and_connection(tmp_path):
    pytest.importorskip("cryptography")
    from daidalos.cli.ros2.keystore.certificates import new_authority, new_certificate

    authority, authority_key = tmp_path / "ca.pem", tmp_path / "ca.key"
    new_authority(authority, authority_key)
    new_certificate("localhost", tmp_path / "a.pem", tmp_path / "a.key", authority, authority_key)
    tls = ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER)
    tls.load_cert_chain(tmp_path / "a.pem", tmp_path / "a.key")
    trusting = ssl.create_default_context(cafile=str(authority))
    trusting.check_hostname = False

    async def run(server):
        assert server.url.startswith("https://")
        address = URL(server.url).with_host("127.0.0.1")
        own = f"https://127.0.0.1:{server.port}"
        jar = aiohttp.CookieJar(unsafe=True)
        async with aiohttp.ClientSession(cookie_jar=jar, connector=aiohttp.TCPConnector(ssl=trusting)) as http:
            async with http.get(address, headers=HTML, allow_redirects=False) as response:
                assert "Secure" in response.headers["Set-Cookie"]
            async with http.ws_connect(own, protocols=[SUBPROTOCOL], origin=own) as socket:
                assert "serverInfo" in await socket.receive_str()
            with pytest.raises(aiohttp.ClientError):
                await http.get(address.with_scheme("http"))

    with StudioServer(MemorySource(), port=0, hosts=("0.0.0.0",), static=tmp_path, tls=tls) as server:
        asyncio.run(run(server))


ASKING = """
import sys, urllib.error, urllib.request
try:
    print(urllib.request.urlopen(sys.argv[1]).status)
except urllib.error.HTTPError as error:
    print(error.code)
"""


@pytest.mark.skipif(not sys.platform.startswith("linux") or os.getuid() != 0, reason="needs the right to change users")
def test_another_user_of_the_machine_is_refused_on_loopback(tmp_path):
    with StudioServer(MemorySource(), port=0, static=tmp_path) as server:
        for host in ("127.0.0.1", "[::1]"):
            words = [sys.executable, "-I", "-S", "-c", ASKING, f"http://{host}:{server.port}/"]
            own = subprocess.run(words, capture_output=True, text=True, check=True)
            assert own.stdout == "200\n"
            system = ["/usr/bin/python3", *words[1:]]
            if not os.access(system[0], os.X_OK):
                pytest.skip("there is no Python that other users may start")
            other = subprocess.run(system, user=65534, capture_output=True, text=True, check=True, cwd="/")
            assert other.stdout == "403\n"


def test_a_connection_that_its_owner_closed_counts_as_another_users():
    import socket

    from daidalos.studio.local_users import is_of_another_user

    with socket.create_server(("127.0.0.1", 0)) as listening:
        client = socket.create_connection(listening.getsockname())
        served, peer = listening.accept()
        with served:
            assert not is_of_another_user(peer, served.getsockname())
            client.close()
            assert is_of_another_user(peer, served.getsockname()) is sys.platform.startswith("linux")


@pytest.mark.parametrize("length", [5_000, 7_000])
def test_a_long_address_is_refused_as_too_long(tmp_path, length):
    async def run(server):
        async with (
            aiohttp.ClientSession() as http,
            http.get(f"http://127.0.0.1:{server.port}/{'a' * length}") as response,
        ):
            assert response.status == 414

    with StudioServer(MemorySource(), port=0, static=tmp_path) as server:
        asyncio.run(run(server))


@pytest.mark.parametrize("name", ["a" * 300, "%00", "a" * 4000])
def test_a_name_that_no_file_can_have_is_not_found(tmp_path, name):
    (tmp_path / "index.html").write_text("page")

    async def run(server):
        address = URL(f"http://127.0.0.1:{server.port}/{name}", encoded=True)
        async with aiohttp.ClientSession() as http, http.get(address) as response:
            assert response.status == 404

    with StudioServer(MemorySource(), port=0, static=tmp_path) as server:
        asyncio.run(run(server))
