"""`kerf serve`: machines that the daemon owns, worked over its API."""

import gzip
import json
import random
import re
import signal
import socket
import tempfile
import time
import unittest

from daemon import Daemon, Live
from kerf_program import DONE, LiveTest, USAGE, VirtualMachine, example, kerf

FAST = "virtual:grblhal?speed=60"
GRBLHAL, RABBIT = "virtual-grblhal", "virtual-rabbit-grbl"


def zigzag(rows):
    lines = ["G21 G90 G94", "G0 Z5", "M3 S1000", "G1 Z-1 F300"]
    for row in range(1, rows + 1):
        lines += [f"G1 X{40 if row % 2 else 0} F3000", f"Y{row * 0.5}"]
    return "\n".join(lines + ["G0 Z5", "M5", "M30", ""])


def is_idle(view):
    return view["snapshot"]["state"] == "Idle"


def phase(view):
    return view.get("job", {}).get("phase")


class Machines(LiveTest):
    def test_a_fresh_install_offers_one_virtual_machine_of_each_firmware(self):
        with Daemon() as daemon:
            for machine in ("virtual-grbl", "virtual-rabbit-grbl", "virtual-grblhal"):
                view = daemon.wait_until_ready(machine)
                self.assertTrue(view["is_virtual"])
                self.assertEqual(view["can"]["jog"], "")

    def test_a_machine_that_is_not_there_is_found_when_it_comes(self):
        with VirtualMachine("grblhal") as first:
            port = first.port
        with Daemon("-m", f"tcp://127.0.0.1:{port}") as daemon:
            machine = next(iter(daemon.get("/state")["state"]["machines"]))
            view = daemon.wait_for_machine(machine, lambda view: view["link"]["phase"] == "Lost", what="Lost")
            self.assertIn("127.0.0.1", view["link"]["sentence"])
            self.assertEqual(daemon.command(machine, "Home")["outcome"], "Refused")
            with VirtualMachine("grblhal", "--listen", f"tcp://127.0.0.1:{port}", tcp=False):
                daemon.wait_until_ready(machine)

    def test_machines_are_added_remembered_and_removed(self):
        with tempfile.TemporaryDirectory() as folder:
            with Daemon(folder=folder) as daemon:
                status, reply = daemon.request("POST", "/api/v1/machines", {"name": "Büro 2", "url": "virtual:grbl"})
                self.assertEqual(status, 201)
                machine = reply["id"]
                for name, url in (("", "virtual:grbl"), ("x", "nowhere:"), ("x", ""), ("x" * 99, "virtual:grbl")):
                    self.assertEqual(daemon.request("POST", "/api/v1/machines", {"name": name, "url": url})[0], 400)
                self.assertEqual(daemon.request("POST", "/api/v1/machines", "no json")[0], 400)
            with Daemon(folder=folder) as daemon:
                self.assertEqual(daemon.wait_until_ready(machine)["name"], "Büro 2")
                self.assertEqual(daemon.request("DELETE", f"/api/v1/machines/{machine}")[0], 200)
                self.assertEqual(daemon.request("DELETE", f"/api/v1/machines/{machine}")[0], 404)
                self.assertEqual(daemon.request("DELETE", "/api/v1/machines/virtual-grbl")[0], 409, "configured")

    def test_says_why_it_cannot_begin(self):
        for arguments in (("--listen", "0.0.0.0:0"), ("--listen", "nonsense"), ("-m", "nowhere:"),
                          ("--state", "/proc/nowhere")):
            ended = kerf("serve", "--listen", "127.0.0.1:0", *arguments) if arguments[0] != "--listen" else kerf(
                "serve", *arguments)
            self.assertEqual(ended.returncode, USAGE, arguments)
            self.assertTrue(ended.stderr.strip(), arguments)


class Page(LiveTest):
    def test_is_in_the_program(self):
        with Daemon("-m", FAST) as daemon:
            status, page = daemon.request("GET", "/")
            self.assertEqual(status, 200)
            assets = re.findall(rb'(?:src|href)="(/[^"]+)"', page)
            self.assertTrue(assets)
            self.assertEqual(re.findall(rb'(?:src|href)="https?:', page), [], "it needs no other server")
            for asset in assets:
                status, plain = daemon.request("GET", asset.decode())
                self.assertEqual(status, 200, asset)
                status, packed = daemon.request("GET", asset.decode(), headers={"Accept-Encoding": "gzip"})
                self.assertIn(plain, (packed, gzip.decompress(packed) if packed[:2] == b"\x1f\x8b" else b""))


class Jobs(LiveTest):
    def test_a_job_from_nothing(self):
        for url, machine in ((FAST, GRBLHAL), ("virtual:rabbit?speed=60", RABBIT)):
            with self.subTest(url), Daemon("-m", url) as daemon:
                daemon.wait_until_ready(machine)
                with open(example("coaster.nc"), encoding="utf-8") as file:
                    program = daemon.upload("coaster.nc", file.read())
                self.assertEqual(daemon.command(machine, "Start")["reason"], "NoProgram")
                self.assertEqual(daemon.command(machine, "Load", program=program)["outcome"], "Accepted")
                daemon.wait_for_machine(machine, lambda view: view.get("program") == program, what="the program")
                check = daemon.get(f"/programs/{program}/check?machine={machine}")
                self.assertEqual(check["errors"], 0)
                self.assertGreater(daemon.get(f"/programs/{program}/estimate?machine={machine}")["total_s"], 60)
                self.assertEqual(daemon.command(machine, "Start")["outcome"], "Accepted")
                daemon.wait_for_machine(machine, lambda view: phase(view) == "Running", what="the job")
                self.assertEqual(daemon.command(machine, "Home")["outcome"], "Refused")
                self.assertEqual(daemon.command(machine, "Hold")["outcome"], "Accepted")
                daemon.wait_for_machine(machine, lambda view: phase(view) == "Held", what="the hold")
                self.assertEqual(daemon.command(machine, "SetOverride", feed=150)["outcome"], "Accepted")
                self.assertEqual(daemon.command(machine, "Resume")["outcome"], "Accepted")
                daemon.wait_for_machine(machine, lambda view: view["snapshot"].get("overrides", {}).get("feed") == 150,
                                        what="the override")

                def goes_on(view):
                    if view["job"]["phase"] == "Held" and view["can"]["resume"] == "":
                        daemon.command(machine, "Resume")  # M0 and M6
                    return view["job"]["phase"] not in ("Running", "Held", "Holding")
                view = daemon.wait_for_machine(machine, goes_on, timeout=60, what="the end")
                self.assertEqual(view["job"]["phase"], "Finished", view["job"])
                jobs = daemon.get(f"/machines/{machine}/jobs")
                self.assertEqual([job["program_id"] for job in jobs], [program])

    def test_a_program_with_errors_does_not_begin(self):
        with Daemon("-m", FAST) as daemon:
            daemon.wait_until_ready(GRBLHAL)
            program = daemon.upload("bad.nc", "G21\nG1 X10 F100\nG77 X3\n")
            daemon.command(GRBLHAL, "Load", program=program)
            daemon.wait_for_machine(GRBLHAL, lambda view: view.get("program"), what="the program")
            self.assertEqual(daemon.command(GRBLHAL, "Start")["outcome"], "Accepted")
            view = daemon.wait_for_machine(
                GRBLHAL, lambda view: view.get("preparation", {}).get("phase") == "Refused", what="the refusal")
            self.assertIn("bad.nc", view["preparation"]["sentence"])
            self.assertTrue(any("G77" in line for line in view["preparation"]["told"]))
            self.assertNotIn("job", view)
            self.assertEqual(view["snapshot"]["machine_position_mm"], [0, 0, 0])

    def test_a_killed_daemon_offers_the_job_and_nothing_moves(self):
        with tempfile.TemporaryDirectory() as folder, VirtualMachine("grblhal", speed="60") as controller:
            machine = "127-0-0-1-" + str(controller.port)
            with Daemon("-m", controller.url, folder=folder) as daemon:
                daemon.wait_until_ready(machine)
                program = daemon.upload("zigzag.nc", zigzag(600))
                daemon.command(machine, "Load", program=program)
                daemon.wait_for_machine(machine, lambda view: view.get("program"), what="the program")
                daemon.command(machine, "Start")
                daemon.wait_for_machine(machine, lambda view: phase(view) == "Running"
                                        and view["job"]["progress"]["lines_acknowledged"] > 30, what="some lines")
                daemon.signal(signal.SIGKILL)
                daemon.process.wait()
            with Daemon("-m", controller.url, folder=folder) as daemon:
                view = daemon.wait_for_machine(machine, lambda view: view["interrupted"] and is_idle(view)
                                               and view["link"]["phase"] == "Ready", timeout=60, what="the offer")
                before = view["snapshot"]["machine_position_mm"]
                time.sleep(0.5)
                self.assertEqual(daemon.machine(machine)["snapshot"]["machine_position_mm"], before)
                job = view["interrupted"][0]["job"]
                self.assertEqual(view["interrupted"][0]["program"], "zigzag.nc")
                self.assertEqual(daemon.command(machine, "ResumeJob", job=job)["outcome"], "Accepted")
                view = daemon.wait_for_machine(
                    machine, lambda view: view["preparation"]["phase"] in ("Asking", "Refused"), what="the plan")
                self.assertTrue(view["preparation"]["told"] or view["preparation"]["sentence"])
                self.assertEqual(daemon.machine(machine)["snapshot"]["machine_position_mm"], before)
                daemon.command(machine, "Decline")
                self.assertEqual(daemon.command(machine, "DismissJob", job=job)["outcome"], "Accepted")
                self.assertEqual(daemon.machine(machine)["interrupted"], [])

    def test_ended_by_a_signal_it_holds_the_machine(self):
        with VirtualMachine("grblhal", speed="1") as controller:
            machine = "127-0-0-1-" + str(controller.port)
            with Daemon("-m", controller.url) as daemon:
                daemon.wait_until_ready(machine)
                program = daemon.upload("zigzag.nc", zigzag(50))
                daemon.command(machine, "Load", program=program)
                daemon.wait_for_machine(machine, lambda view: view.get("program"), what="the program")
                daemon.command(machine, "Start")
                daemon.wait_for_machine(machine, lambda view: view["snapshot"]["state"] == "Run", what="motion")
                daemon.signal(signal.SIGTERM)
                self.assertEqual(daemon.wait(), DONE)
            ended = kerf("status", "--json", "--machine", controller.url)
            self.assertEqual(json.loads(ended.stdout)["machine"]["state"], "Hold")


class LiveState(LiveTest):
    def test_patches_make_the_state_and_a_number_goes_on(self):
        with Daemon("-m", FAST) as daemon, Live(daemon.port) as live:
            live.wait_for(lambda state: state["machines"][GRBLHAL]["link"]["phase"] == "Ready")
            live.ask(type="command", machine=GRBLHAL, command="JogStep", distance={"X": 10}, feed_mm_per_min=500)
            live.wait_for(lambda state: state["machines"][GRBLHAL]["snapshot"]["machine_position_mm"][0] == 10
                          and is_idle(state["machines"][GRBLHAL]))
            number = live.number
            with Live(daemon.port, start=number) as again:
                again.read_for(0.5)
                self.assertEqual(again.kinds[0], "hello")
                self.assertNotIn("snapshot", again.kinds)
            with Live(daemon.port, start=10**9) as stranger:
                stranger.frame(), stranger.frame()
                self.assertEqual(stranger.kinds[:2], ["hello", "snapshot"])
            live.read_for(0.3)
            state = daemon.get("/state")
            self.assertEqual(state["state"]["machines"].keys(), live.state["machines"].keys())

    def test_a_key_has_one_effect(self):
        with Daemon("-m", FAST) as daemon:
            daemon.wait_until_ready(GRBLHAL)
            for _ in range(3):
                answer = daemon.command(GRBLHAL, "JogStep", key="once", distance={"X": 1}, feed_mm_per_min=500)
                self.assertEqual(answer["outcome"], "Accepted")
            view = daemon.wait_for_machine(
                GRBLHAL, lambda view: is_idle(view) and view["snapshot"]["machine_position_mm"][0] > 0, what="the jog")
            time.sleep(0.3)
            self.assertEqual(daemon.machine(GRBLHAL)["snapshot"]["machine_position_mm"][0], 1)

    def test_traffic_is_for_those_who_watch(self):
        with Daemon("-m", FAST) as daemon, Live(daemon.port) as live:
            live.wait_for(lambda state: state["machines"][GRBLHAL]["link"]["phase"] == "Ready")
            self.assertEqual(live.traffic, [])
            live.send(type="watch", traffic=[GRBLHAL])
            live.ask(type="command", machine=GRBLHAL, command="SendLine", text="G4P0.01")
            live.read_for(0.5)
            self.assertIn(("Sent", "G4P0.01"), [(line["direction"], line["text"]) for line in live.traffic])
            numbers = [line["number"] for line in live.traffic]
            self.assertEqual(numbers, sorted(set(numbers)))


class HeldJogs(LiveTest):
    def hold(self, live, machine, seconds):
        answer = live.ask(type="jog", machine=machine, direction={"X": 1}, feed_mm_per_min=500)
        self.assertEqual(answer["outcome"], "Accepted", answer)
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            live.send(type="jog-renew", machine=machine)
            live.read_for(0.05)

    def test_move_while_held_and_stop_when_released_or_lost(self):
        machine = "virtual-grblhal"
        with Daemon("-m", "virtual:grblhal") as daemon:
            daemon.wait_until_ready(machine)
            for lost in (False, True):
                with self.subTest(lost=lost), Live(daemon.port) as live:
                    live.wait_for(lambda state: machine in state["machines"])
                    self.hold(live, machine, 1.5)
                    at = live.state["machines"][machine]["snapshot"]["machine_position_mm"][0]
                    if lost:
                        live.socket.close()
                    else:
                        live.send(type="jog-release", machine=machine)
                    view = daemon.wait_for_machine(machine, is_idle, what="standing still")
                    self.assertNotIn("jog", view)
                    self.assertLess(view["snapshot"]["machine_position_mm"][0] - at, 2.5)
                    self.assertGreater(view["snapshot"]["machine_position_mm"][0], 2)

    def test_is_held_by_one_client(self):
        machine = "virtual-grblhal"
        with Daemon("-m", "virtual:grblhal") as daemon, Live(daemon.port) as one, Live(daemon.port) as other:
            daemon.wait_until_ready(machine)
            one.wait_for(lambda state: machine in state["machines"])
            self.hold(one, machine, 0.2)
            answer = other.ask(type="jog", machine=machine, direction={"X": -1}, feed_mm_per_min=500)
            self.assertEqual(answer["reason"], "JogHeldElsewhere")
            self.assertEqual(other.ask(type="command", machine=machine, command="Stop")["outcome"], "Accepted")
            daemon.wait_for_machine(machine, lambda view: is_idle(view) and "jog" not in view, what="standing still")


def by_chance(dice, schema, schemas, depth=0):
    """A value that the schema allows, or, now and then, any other."""
    if dice.random() < 0.15 or depth > 4:
        return dice.choice([None, True, -1, 1e308, "", "x" * 300, "\x00\u2028", [], {}, [[[]]], {"a": {"b": 1}}])
    if "$ref" in schema:
        return by_chance(dice, schemas[schema["$ref"].rsplit("/", 1)[1]], schemas, depth + 1)
    for several in ("allOf", "oneOf"):
        if several in schema:
            return by_chance(dice, dice.choice(schema[several]), schemas, depth + 1)
    if "enum" in schema:
        return dice.choice(schema["enum"])
    kind = schema.get("type")
    if kind == "object":
        members = {name: by_chance(dice, one, schemas, depth + 1)
                   for name, one in schema.get("properties", {}).items() if dice.random() < 0.8}
        if "additionalProperties" in schema and isinstance(schema["additionalProperties"], dict):
            members[dice.choice(["X", "Y", "Z", "Q", ""])] = by_chance(
                dice, schema["additionalProperties"], schemas, depth + 1)
        return members
    if kind == "array":
        return [by_chance(dice, schema["items"], schemas, depth + 1) for _ in range(dice.randrange(3))]
    texts = ["", "G0 X1", "$X", "part.nc", "XY", "G54", "virtual:grbl", "%2e%2e/", "\U0001F600"]
    return {"boolean": dice.random() < 0.5, "integer": dice.randrange(-5, 200), "number": dice.uniform(-100, 100),
            "string": dice.choice(texts)}[kind]


class Document(LiveTest):
    def test_requests_by_chance_from_the_apis_own_document(self):
        """In check mode nothing moves, whatever is asked."""
        dice = random.Random(7)
        with Daemon("-m", FAST, "--program", example("facing.nc")) as daemon:
            daemon.wait_until_ready(GRBLHAL)
            daemon.command(GRBLHAL, "SendLine", text="$C")
            daemon.wait_for_machine(GRBLHAL, lambda view: view["snapshot"]["state"] == "Check", what="check mode")
            document = daemon.get("/openapi.json")
            schemas = document["components"]["schemas"]
            titles = [one["title"] for one in schemas["Command"]["oneOf"]]
            # What leaves check mode would let things move.
            kept = [title for title in titles if title not in ("SoftReset", "Abort", "Stop", "Disconnect", "SendLine")]
            statuses = set()
            for _ in range(1500):
                path = dice.choice(list(document["paths"]))
                method = dice.choice(list(document["paths"][path])).upper()
                address = path.replace("{machine}", dice.choice([GRBLHAL, "nobody"]))
                programs = [*daemon.get("/state")["state"]["programs"], "0123"]
                address = address.replace("{program}", dice.choice(programs))
                body = None
                if path.endswith("/commands"):
                    title = dice.choice(kept)
                    schema = next(one for one in schemas["Command"]["oneOf"] if one["title"] == title)
                    members = by_chance(dice, schema, schemas)
                    body = json.dumps({"command": title, **(members if isinstance(members, dict) else {"x": members})})
                elif method == "POST" and path.endswith("/machines"):
                    body = json.dumps(by_chance(dice, schemas["MachineToAdd"], schemas))
                elif method == "DELETE" and dice.random() < 0.9:
                    continue
                elif path.endswith("/ports"):
                    continue  # it listens to the network for a while
                status = daemon.request(method, address, body)[0]
                statuses.add(status)
                self.assertLess(status, 500, (method, address, body))
            self.assertLess({200, 400, 404}, statuses | {409})
            self.assertEqual(daemon.machine(GRBLHAL)["snapshot"]["machine_position_mm"], [0, 0, 0])


class Refusals(LiveTest):
    def test_what_is_not_for_us_or_not_from_us(self):
        with Daemon("-m", FAST, "--program", example("facing.nc")) as daemon:
            daemon.wait_until_ready(GRBLHAL)
            daemon.wait_for_machine(GRBLHAL, lambda view: view.get("program"), what="the program")
            root = "/api/v1"
            commands = f"{root}/machines/{GRBLHAL}/commands"
            start = {"command": "Start"}
            cases = [
                ("GET", "/nothing", None, {}, 404),
                ("GET", root + "/nothing", None, {}, 404),
                ("POST", root + "/state", "{}", {}, 405),
                ("POST", "/", "x", {}, 405),
                ("GET", root + "/state", None, {"Host": "evil.example"}, 403),
                ("POST", commands, start, {"Host": "evil.example"}, 403),
                ("POST", commands, start, {"Origin": "http://evil.example"}, 403),
                ("POST", commands, start, {"Origin": "null"}, 403),
                ("POST", commands, "{", {}, 400),
                ("POST", commands, "[" * 50000, {}, 400),
                ("POST", commands, {"command": "Start", "now": 1}, {}, 400),
                ("POST", commands, {"command": 7}, {}, 400),
                ("POST", commands, {"command": "Start", "key": 7}, {}, 400),
                ("POST", commands, "x" * (1 << 21), {}, 413),
                ("POST", root + "/machines/nobody/commands", start, {}, 404),
                ("POST", root + "/programs", "G0", {}, 400),
                ("POST", root + "/programs?name=", "G0", {}, 400),
                ("GET", root + "/programs/../../etc/passwd/text", None, {}, 400),
                ("GET", root + "/programs/%2e%2e%2fx/text", None, {}, 400),
                ("GET", root + "/programs/0123/text", None, {}, 404),
                ("GET", root + "/programs/0123/text?first=x", None, {}, 400),
                ("GET", root + "/programs/0123/toolpath", None, {}, 404),
            ]
            for method, path, body, headers, expected in cases:
                with self.subTest(method=method, path=path, headers=headers):
                    self.assertEqual(daemon.request(method, path, body, headers)[0], expected)
            view = daemon.machine(GRBLHAL)
            self.assertNotIn("job", view)
            self.assertEqual(view["snapshot"]["machine_position_mm"], [0, 0, 0])

    def test_websockets_of_foreign_pages(self):
        with Daemon("-m", FAST) as daemon:
            with Live(daemon.port, headers="Origin: http://evil.example\r\n") as live:
                self.assertEqual(live.status, 403)
            with Live(daemon.port, headers=f"Origin: http://127.0.0.1:{daemon.port}\r\n") as live:
                self.assertEqual(live.status, 101)

    def test_clients_that_send_rubbish_or_nothing(self):
        with Daemon("-m", FAST) as daemon, Live(daemon.port) as live:
            live.frame()
            for text in (b"", b"{", b"[]", b"7", b'{"type":7}', b'{"type":"jog"}', b'{"type":"nope","machine":"x"}',
                         b'{"type":"command","machine":"' + GRBLHAL.encode() + b'","command":"Nope"}'):
                live.send_frame(1, text)
            live.read_for(0.3)
            with socket.create_connection(("127.0.0.1", daemon.port)) as raw:
                raw.sendall(b"\x16\x03\x01\x02\x00rubbish\r\n\r\n")
                raw.settimeout(5)
                self.assertIn(b"400", raw.recv(1000))
            idle = [socket.create_connection(("127.0.0.1", daemon.port)) for _ in range(50)]
            self.assertEqual(daemon.wait_until_ready(GRBLHAL)["can"]["jog"], "")
            for connection in idle:
                connection.close()


if __name__ == "__main__":
    unittest.main()
