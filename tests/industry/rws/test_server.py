"""Robot Web Services over a running program, as clients of both versions use them."""

import asyncio
import base64
import hashlib
import json
import re
import ssl
import threading
import time

import aiohttp
import pytest
from aiohttp.test_utils import TestServer

from daidalos.industry.rapid.checking import Checker
from daidalos.industry.rapid.parsing import parse
from daidalos.industry.rapid.runtime.arm_robot import ArmRobot
from daidalos.industry.rapid.runtime.board import Board
from daidalos.industry.rapid.runtime.task import Task
from daidalos.industry.rapid.sources import Source
from daidalos.industry.robots import ARMS
from daidalos.industry.rws.access import Access
from daidalos.industry.rws.certificate import self_signed_context
from daidalos.industry.rws.controller import VirtualController
from daidalos.industry.rws.server import RwsServer

PATIENCE_S = 30.0
PROGRAM = """MODULE Cell
  PERS num count := 0;
  PERS string name := "Jan";
  CONST num limit := 3;
  PERS tooldata pen := [TRUE,[[0,0,100],[1,0,0,0]],[0.1,[0,0,50],[1,0,0,0],0,0,0]];
  PROC main()
    WHILE TRUE DO
      WaitDI diGo, 1;
      count := count + 1;
      MoveAbsJ [[20,10,-10,0,40,0],[9E9,9E9,9E9,9E9,9E9,9E9]], v1000, fine, tool0;
      SetDO doDone, 1;
      WaitDI diGo, 0;
    ENDWHILE
  ENDPROC
ENDMODULE
"""
ENDLESS = """MODULE Cell
  PERS num count := 0;
  PROC main()
    WHILE TRUE DO
      count := count + 1;
    ENDWHILE
  ENDPROC
ENDMODULE
"""
SYMBOL = "/rw/rapid/symbol/data/RAPID/T_ROB1/Cell"


def controller_of(text=PROGRAM):
    def make_task(pace):
        modules = [parse(Source("cell.mod", text))]
        checker = Checker(modules, [])
        checker.check()
        signals = Board(["diGo", "doDone", "aoSpeed"])
        return Task(modules, checker, ArmRobot(ARMS["irb120"]), signals, pace=pace)

    return VirtualController(make_task, threading.Event().wait)


class Client:
    """A client of version 1.0 with JSON, by the digest authentication of aiohttp."""

    def __init__(self, session, url):
        self._session, self._url = session, url

    async def get(self, path, **query):
        async with self._session.get(self._url + path, params={"json": "1", **query}) as answer:
            document = json.loads(await answer.text())
            return (
                document["_embedded"]["_state"] if answer.status == 200 else (answer.status, document["status"]["msg"])
            )

    async def value(self, name):
        return (await self.get(f"{SYMBOL}/{name}"))[0]["value"]

    async def post(self, path, action, **form):
        async with self._session.post(self._url + path, params={"action": action, "json": "1"}, data=form) as answer:
            text = await answer.text()
            return answer.status, json.loads(text)["status"]["msg"] if text else ""

    async def until(self, path, name, value):
        end = time.monotonic() + PATIENCE_S
        while time.monotonic() < end:
            if (await self.get(path))[0][name] == value:
                return
            await asyncio.sleep(0.01)
        raise AssertionError(f"{path} has no {name} = {value}")


def served(test, text=PROGRAM, password="robotics"):
    """Run a test with a client of a controller."""

    async def run():
        controller = controller_of(text)
        server = TestServer(RwsServer(controller).application())
        await server.start_server()
        digest = aiohttp.DigestAuthMiddleware("Default User", password)
        try:
            async with aiohttp.ClientSession(middlewares=(digest,), cookie_jar=aiohttp.DummyCookieJar()) as session:
                return await test(Client(session, str(server.make_url("")).rstrip("/")), session)
        finally:
            await server.close()
            controller.close()

    return asyncio.run(run())


def test_a_program_is_started_follows_signals_and_is_stopped():
    async def test(client, session):
        assert (await client.get("/rw/rapid/execution"))[0]["ctrlexecstate"] == "stopped"
        start = {"regain": "continue", "execmode": "continue", "cycle": "forever", "condition": "none"}
        assert await client.post("/rw/rapid/execution", "start", **start) == (204, "")
        await client.until("/rw/rapid/execution", "ctrlexecstate", "running")
        assert await client.post("/rw/iosystem/signals/Local/Board/diGo", "set", lvalue="1") == (204, "")
        await client.until("/rw/iosystem/signals/doDone", "lvalue", "1")
        assert await client.value("count") == "1"
        joints = (await client.get("/rw/motionsystem/mechunits/ROB_1/jointtarget"))[0]
        assert [float(joints[f"rax_{k}"]) for k in range(1, 7)] == pytest.approx([20, 10, -10, 0, 40, 0], abs=1e-3)
        assert joints["eax_a"] == "9E+09"
        assert await client.post("/rw/rapid/execution", "stop", stopmode="stop") == (204, "")
        assert (await client.get("/rw/rapid/execution"))[0]["ctrlexecstate"] == "stopped"
        assert await client.post("/rw/rapid/execution", "start") == (204, "")
        await client.post("/rw/iosystem/signals/diGo", "set", lvalue="0")
        await client.post("/rw/rapid/execution", "stop")
        assert await client.post("/rw/rapid/execution", "resetpp") == (204, "")
        assert await client.value("count") == "1"

    served(test)


def test_positions_are_those_of_tools():
    async def test(client, session):
        path = "/rw/motionsystem/mechunits/ROB_1/robtarget"
        bare, pen = (await client.get(path))[0], (await client.get(path, tool="pen", wobj="wobj0"))[0]
        ways = [float(pen[axis]) - float(bare[axis]) for axis in "xyz"]
        assert sum(way**2 for way in ways) ** 0.5 == pytest.approx(100.0, abs=1e-4)
        assert {"q1", "q2", "q3", "q4", "cf1", "cf4", "cf6", "cfx"} <= pen.keys()
        assert await client.get(path, tool="pem") == (404, "there is no tool 'pem'")

    served(test)


def test_data_is_read_and_written_and_wrong_values_change_nothing():
    async def test(client, session):
        assert await client.post(f"{SYMBOL}/count", "set", value="41.5") == (204, "")
        assert await client.post(f"{SYMBOL}/name", "set", value='"Eva"') == (204, "")
        assert [await client.value(name) for name in ("count", "name", "limit")] == ["41.5", '"Eva"', "3"]
        for name, value, status, message in (
            ("count", "many", 400, "'many' is no num"),
            ("count", "[1]", 400, r"'\[1\]' is no num"),
            ("pen", "[TRUE]", 400, r"'\[TRUE\]' is no tooldata"),
            ("limit", "4", 403, "'limit' is a constant"),
            ("cuont", "1", 404, "there is no data 'cuont'; did you mean 'count'?"),
        ):
            found = await client.post(f"{SYMBOL}/{name}", "set", value=value)
            assert found[0] == status
            assert re.search(message, found[1])
        assert await client.value("count") == "41.5"
        assert await client.post(f"{SYMBOL}/count", "set") == (400, "'value' is missing")
        assert await client.get("/rw/rapid/symbol/data/RAPID/T_ROB1/Other/count") == (
            404,
            "module 'Other' has no data 'count'",
        )

    served(test)


def test_the_panel_is_read_and_set():
    async def test(client, session):
        assert (await client.get("/rw/panel/opmode"))[0]["opmode"] == "AUTO"
        assert await client.post("/rw/panel/speedratio", "setspeedratio", **{"speed-ratio": "50"}) == (204, "")
        assert (await client.get("/rw/panel/speedratio"))[0]["speedratio"] == "50"
        status, message = await client.post("/rw/panel/speedratio", "setspeedratio", **{"speed-ratio": "150"})
        assert (status, message) == (403, "the speed ratio is 150, but must be from 0 to 100")
        assert await client.post("/rw/panel/ctrlstate", "setctrlstate", **{"ctrl-state": "motoroff"}) == (204, "")
        assert (await client.get("/rw/panel/ctrlstate"))[0]["ctrlstate"] == "motoroff"
        assert await client.post("/rw/rapid/execution", "start") == (403, "the motors are off")

    served(test)


@pytest.mark.parametrize(
    ("path", "action", "form", "status", "message"),
    [
        ("/rw/iosystem/signals/diNone", "set", {"lvalue": "1"}, 404, "there is no signal 'diNone'"),
        ("/rw/iosystem/signals/diGo", "set", {"lvalue": "nan"}, 400, "lvalue is nan, but must be finite"),
        ("/rw/iosystem/signals/diGo", "set", {"lvalue": "on"}, 400, "lvalue is 'on', but must be a number"),
        ("/rw/rapid/execution", "sart", {}, 404, "there is no action 'sart' of 'rw/rapid/execution'"),
        ("/rw/panel/ctrlstate", "setctrlstate", {"ctrl-state": "on"}, 400, "must be motoron or motoroff"),
    ],
)
def test_what_is_wrong_is_said(path, action, form, status, message):
    async def test(client, session):
        found = await client.post(path, action, **form)
        assert found[0] == status
        assert message in found[1]

    served(test)


def test_a_program_that_lets_no_time_pass_is_stopped():
    async def test(client, session):
        assert (await client.post("/rw/rapid/execution", "start"))[0] == 204
        assert (await client.post("/rw/rapid/execution", "stop"))[0] == 204
        assert (await client.get("/rw/rapid/execution"))[0]["ctrlexecstate"] == "stopped"
        before = await client.value("count")
        assert await client.value("count") == before

    served(test, ENDLESS)


def test_changes_are_sent_over_a_web_socket():
    async def test(client, session):
        names = ("/rw/rapid/execution;ctrlexecstate", f"{SYMBOL}/count;value", "/rw/iosystem/signals/doDone;state")
        form = {"resources": ["1", "2", "3"], **{str(k): name for k, name in enumerate(names, 1)}, "1-p": "1"}
        async with session.post(client._url + "/subscription", data=form) as answer:
            assert answer.status == 201
            assert answer.headers["Location"].startswith("ws://")
            where = answer.headers["Location"].replace("ws://", "http://")
        async with session.ws_connect(where, protocols=["robapi2_subscription"]) as socket:
            assert socket.protocol == "robapi2_subscription"
            await client.post("/rw/rapid/execution", "start")
            first = await socket.receive_str(timeout=10)
            assert '<li class="rap-ctrlexecstate-ev"' in first
            assert '<span class="ctrlexecstate">running</span>' in first
            await client.post("/rw/iosystem/signals/diGo", "set", lvalue="1")
            text = ""
            while not ("rap-value-ev" in text and "ios-signalstate-ev" in text):
                text += await socket.receive_str(timeout=10)
            assert f'<a href="{SYMBOL}/count;value" rel="self">' in text
        assert await client.get("/rw/nothing") == (404, "there is no resource 'rw/nothing'")
        async with session.post(client._url + "/subscription", data={"resources": "1"}) as answer:
            assert answer.status == 400

    served(test)


def test_a_wrong_password_is_refused():
    async def test(client, session):
        assert await client.get("/rw/panel/opmode") == (401, "who you are is not known")

    served(test, password="wrong")


def test_an_answer_to_a_challenge_counts_once():
    access = Access("user", "secret")
    nonce = re.search('nonce="(.*?)"', access.challenge())[1]
    header = (
        f'Digest username="user", realm="validusers@robapi.abb", nonce="{nonce}", uri="/rw", qop=auth, nc=00000001, '
        f'cnonce="c", response="{digest(nonce)}"'
    )
    assert not access.allows(header, "POST", "/rw")
    assert not access.allows(header, "GET", "/rw/other")
    assert access.allows(header, "GET", "/rw")
    assert not access.allows(header, "GET", "/rw")
    assert not access.allows("Digest nonsense", "GET", "/rw")


def digest(nonce):
    def md5(text):
        return hashlib.md5(text.encode()).hexdigest()

    return md5(f"{md5('user:validusers@robapi.abb:secret')}:{nonce}:00000001:c:auth:{md5('GET:/rw')}")


def test_version_2_is_served_over_tls_with_its_own_paths():
    pytest.importorskip("cryptography")

    async def run():
        controller = controller_of()
        server = TestServer(RwsServer(controller, 2).application())
        await server.start_server(ssl=self_signed_context("127.0.0.1"))
        trusting = ssl.create_default_context()
        trusting.check_hostname, trusting.verify_mode = False, ssl.CERT_NONE
        url = str(server.make_url("")).rstrip("/")
        basic = base64.b64encode(b"Default User:robotics").decode()
        accept = {"Accept": "application/hal+json;v=2.0", "Authorization": f"Basic {basic}"}
        connector = aiohttp.TCPConnector(ssl=trusting)
        try:
            async with aiohttp.ClientSession(headers=accept, connector=connector) as session:
                async with session.post(f"{url}/rw/rapid/execution/start", data={"regain": "continue"}) as answer:
                    assert answer.status == 204
                async with session.get(f"{url}/rw/rapid/execution") as answer:
                    assert answer.headers["Content-Type"] == "application/hal+json;v=2.0"
                    assert json.loads(await answer.text())["state"][0]["ctrlexecstate"] == "running"
                symbol = f"{url}/rw/rapid/symbol/RAPID/T_ROB1/Cell/count/data"
                async with session.post(symbol, data={"value": "7"}) as answer:
                    assert answer.status == 204
                async with session.get(symbol) as answer:
                    assert json.loads(await answer.text())["state"][0]["value"] == "7"
                async with session.post(f"{url}/rw/iosystem/signals/diGo/set-value", data={"lvalue": "1"}) as answer:
                    assert answer.status == 204
                async with session.get(f"{url}/rw/iosystem/signals") as answer:
                    found = json.loads(await answer.text())["_embedded"]["resources"]
                    assert {one["name"]: one["lvalue"] for one in found}["diGo"] == "1"
                async with session.post(f"{url}/rw/panel/ctrl-state", data={"ctrl-state": "motoroff"}) as answer:
                    assert answer.status == 204
                async with session.get(f"{url}/rw/panel/ctrl-state") as answer:
                    assert json.loads(await answer.text())["state"][0]["ctrlstate"] == "motoroff"
            async with (
                aiohttp.ClientSession(connector=aiohttp.TCPConnector(ssl=trusting)) as session,
                session.get(f"{url}/rw/panel/opmode") as answer,
            ):
                assert (answer.status, answer.headers["WWW-Authenticate"][:5]) == (401, "Basic")
        finally:
            await server.close()
            controller.close()

    asyncio.run(run())
