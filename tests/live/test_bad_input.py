"""Every wrong input gets one clear sentence and the right exit status, and nothing moves."""

import os
import pty
import socket
import unittest

from kerf_program import (
    ALARM, NO_CONNECTION, USAGE, LiveTest, Peer, Running, VirtualMachine, example, free_port, kerf)


class Files(LiveTest):
    def run_file(self, path):
        return kerf("run", path, "--machine", "virtual:grbl?speed=max")

    def test_missing(self):
        self.assert_complains(self.run_file(self.folder + "/no.nc"), USAGE, "no.nc", "check the name")

    def test_folder(self):
        self.assert_complains(self.run_file(self.folder), USAGE, self.folder, "folder")

    def test_unreadable(self):
        path = self.file("secret.nc", "G0 X1\n")
        os.chmod(path, 0)
        if os.access(path, os.R_OK):
            self.skipTest("the superuser can read everything")
        self.assert_complains(self.run_file(path), USAGE, "secret.nc", "permission")

    def test_device(self):
        self.assert_complains(self.run_file("/dev/null"), USAGE, "/dev/null", "device")

    def test_empty(self):
        for content in ("", "\n\n", "(only a comment)\n; and another\n"):
            with self.subTest(content):
                self.assert_complains(self.run_file(self.file("empty.nc", content)), USAGE, "empty.nc")

    def test_binary(self):
        for content in (bytes(range(256)), b"\x7fELF\x02\x01\x01\0\0", b"G0 X1\0\n"):
            with self.subTest(content[:4]):
                self.assert_complains(self.run_file(self.file("part.bin", content)), USAGE, "part.bin")

    def test_realtime_character_in_a_line(self):
        result = self.run_file(self.file("live.nc", "G21\nG0 X1 ! Y2\n"))
        self.assert_complains(result, USAGE, "live.nc", "2")

    def test_line_longer_than_the_controller_takes(self):
        program = self.file("long.nc", "G21\nG1 X" + "0" * 300 + "1 F100\n")
        for personality in ("grbl", "rabbit", "grblhal"):
            with self.subTest(personality):
                result = kerf("run", program, "--machine", f"virtual:{personality}?speed=max")
                self.assert_complains(result, USAGE, "2")
                self.assertNotIn("Cutting", result.stdout)


class Options(LiveTest):
    def test_unknown_option(self):
        self.assert_complains(kerf("run", example("facing.nc"), "--turbo"), USAGE, "--turbo", "kerf run --help")

    def test_unknown_command(self):
        self.assert_complains(kerf("cut", "part.nc"), USAGE, "cut", "kerf --help")

    def test_missing_file_argument(self):
        self.assert_complains(kerf("run"), USAGE, "FILE", "kerf run --help")

    def test_no_command_shows_the_help(self):
        result = kerf()
        self.assertEqual(result.returncode, USAGE)
        self.assertIn("kerf run", result.stdout)

    def test_addresses(self):
        for url, word in (("ftp://host:81", "ftp"), ("host", "host:PORT"), ("host:99999", "99999"),
                          ("virtual:marlin", "marlin"), ("virtual:grbl?speed=warp", "warp"),
                          ("/dev/ttyUSB0?baud=fast", "fast"), ("", "empty")):
            for command in (["run", example("facing.nc")], ["info"], ["console"]):
                with self.subTest(url=url, command=command[0]):
                    self.assert_complains(kerf(*command, "--machine", url), USAGE, word)

    def test_virtual(self):
        self.assert_complains(kerf("virtual", "--personality", "marlin", "--listen", "127.0.0.1:0"), USAGE, "marlin")
        self.assert_complains(kerf("virtual"), USAGE, "--listen")
        self.assert_complains(kerf("virtual", "--listen", "here"), USAGE, "here")
        self.assert_complains(kerf("virtual", "--listen", "127.0.0.1:0", "--speed", "-1"), USAGE, "-1")
        missing = self.folder + "/no"
        self.assert_complains(kerf("virtual", "--listen", "127.0.0.1:0", "--settings", missing), USAGE, missing)
        settings = self.file("settings", "$110=500\n$9999=1\n")
        self.assert_complains(kerf("virtual", "-p", "grbl", "--listen", "127.0.0.1:0", "--settings", settings), USAGE,
                              "$9999")
        settings = self.file("settings", "$110=500\nG0 X1\n")
        self.assert_complains(kerf("virtual", "--listen", "127.0.0.1:0", "--settings", settings), USAGE, "line 2")
        taken = self.file("taken", "")
        self.assert_complains(kerf("virtual", "--pty", taken), USAGE, "taken")
        with socket.create_server(("127.0.0.1", 0)) as server:
            port = server.getsockname()[1]
            self.assert_complains(kerf("virtual", "--listen", f"127.0.0.1:{port}"), USAGE, str(port), "in use")


class Connections(LiveTest):
    def commands(self):
        return (["run", example("facing.nc")], ["info"], ["console"])

    def check(self, url, status, *words):
        for command in self.commands():
            with self.subTest(command=command[0]):
                self.assert_complains(kerf(*command, "--machine", url), status, *words)

    def test_unplugged(self):
        self.check("/dev/ttyUSB97", NO_CONNECTION, "/dev/ttyUSB97", "plug")

    def test_no_port_but_a_file(self):
        self.check("serial://" + self.file("file", "text"), NO_CONNECTION, "not a port")

    def test_refused(self):
        port = free_port()
        self.check(f"127.0.0.1:{port}", NO_CONNECTION, str(port), "refused")

    def test_unknown_host(self):
        self.check("no-such-host.invalid:23", NO_CONNECTION, "no-such-host.invalid")

    def test_busy_port(self):
        path = os.path.join(self.folder, "machine")
        with VirtualMachine("grbl", tcp=False, pty_path=path):
            with Running("console", "--machine", path, stdin=-1) as first:
                first.wait_for(r"Grbl")
                self.check(path, NO_CONNECTION, path, "in use")

    def test_second_tcp_client_is_turned_away(self):
        with VirtualMachine("grbl") as machine:
            with socket.create_connection(("127.0.0.1", machine.port)):
                machine.wait_for("connected")
                self.check(machine.url, NO_CONNECTION, str(machine.port))
                machine.wait_for("turned away")

    def test_nobody_answers(self):
        with Peer() as peer:
            result = kerf("run", example("facing.nc"), "--machine", peer.url)
            self.assert_complains(result, NO_CONNECTION)
            self.assertNotRegex(peer.heard, rb"[GXYZ]\d")

    def test_silent_pty(self):
        controller, client = pty.openpty()
        try:
            result = kerf("info", "--machine", os.ttyname(client))
            self.assert_complains(result, NO_CONNECTION)
        finally:
            os.close(controller)
            os.close(client)

    def test_peers_that_are_no_grbl(self):
        web = b"HTTP/1.1 400 Bad Request\r\nContent-Length: 0\r\n\r\n"
        marlin = b"start\r\necho:Marlin 2.1.2\r\n"
        noise = bytes(range(256)) * 4
        for name, says in (("web", web), ("marlin", marlin), ("noise", noise)):
            with self.subTest(name), Peer(lambda heard, says=says: says if heard else b"") as peer:
                result = kerf("run", example("facing.nc"), "--machine", peer.url)
                self.assert_complains(result, NO_CONNECTION)
                self.assertNotRegex(peer.heard, rb"[GXYZ]\d")

    def test_alarm_before_the_job(self):
        settings = self.file("settings", "$22=1\n")
        with VirtualMachine("grbl", "--settings", settings) as machine:
            result = kerf("run", example("facing.nc"), "--machine", machine.url)
            self.assert_complains(result, ALARM)
            self.assertNotIn("Cutting", result.stdout)


if __name__ == "__main__":
    unittest.main()
