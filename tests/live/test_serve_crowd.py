"""A crowd of clients during a job: the machine must not notice them. And Stop acts at once, whoever else is busy."""

import os
import random
import threading
import time
import unittest

from daemon import Daemon, Live
from kerf_program import LiveTest

MACHINE = "virtual-grblhal"
URL = "virtual:grblhal?speed=30"


def job(rows):
    lines = ["G21 G90 G94", "G0 Z5", "M3 S1000", "G1 Z-1 F500"]
    for row in range(1, rows + 1):
        lines += [f"G1 X{10 if row % 2 else 0} F500", f"Y{row * 0.1:.1f}"]
    return "\n".join(lines + ["G0 Z5", "M5", "M30", ""])


def start(daemon):
    daemon.wait_until_ready(MACHINE)
    program = daemon.upload("crowd.nc", job(60))
    daemon.command(MACHINE, "Load", program=program)
    daemon.wait_for_machine(MACHINE, lambda view: view.get("program"), what="the program")
    assert daemon.command(MACHINE, "Start")["outcome"] == "Accepted"
    daemon.wait_for_machine(MACHINE, lambda view: "job" in view, what="the job")




class Misbehaviour(threading.Thread):
    """A client that comes and goes, reads too slowly or not at all, and sends rubbish."""

    def __init__(self, port, seed, until):
        super().__init__(daemon=True)
        self.port, self.dice, self.until = port, random.Random(seed), until

    def run(self):
        while not self.until.is_set():
            try:
                self.visit()
            except (OSError, AssertionError, ConnectionError):
                pass  # it was shown the door

    def visit(self):
        deed = self.dice.randrange(6)
        with Live(self.port, start=self.dice.choice([None, 0, 5])) as live:
            if deed == 0:
                live.read_for(self.dice.uniform(0, 0.5))
            elif deed == 1:
                self.until.wait(self.dice.uniform(0, 1.5))  # never reads
            elif deed == 2:
                for _ in range(50):
                    live.send_frame(1, os.urandom(self.dice.randrange(200)).hex().encode())
            elif deed == 3:
                live.send(type="watch", traffic=[MACHINE, "nobody"])
                live.read_for(0.3)
            elif deed == 4:
                live.send(type="jog", machine=MACHINE, key="k", direction={"X": 1}, feed_mm_per_min=100)
                live.read_for(0.2)
            else:
                live.send(type="command", machine=MACHINE, key="x", command="Home")
                live.send(type="command", machine=MACHINE, key="y", command="SendLine", text="G0X100")
                live.read_for(0.2)


class Crowd(LiveTest):
    def run_job(self, clients):
        """Every line that was sent up to the end of the job, but for questions, which come by the clock."""
        with Daemon("-m", URL) as daemon, Live(daemon.port) as live:
            live.wait_for(lambda state: MACHINE in state["machines"])
            live.send(type="watch", traffic=[MACHINE])
            over = threading.Event()
            crowd = [Misbehaviour(daemon.port, seed, over) for seed in range(clients)]
            start(daemon)
            for client in crowd:
                client.start()
            try:
                live.wait_for(lambda state: state["machines"][MACHINE].get("job", {}).get("phase")
                              not in (None, "Running"), timeout=60, what="the end")
                live.read_for(0.5)
            finally:
                over.set()
                for client in crowd:
                    client.join(10)
            self.assertEqual(live.state["machines"][MACHINE]["job"]["phase"], "Finished")
            sent = [line for line in live.traffic if line["direction"] == "Sent" and line["purpose"] != "Question"]
            # Behind the end everybody may jog.
            end = next(at for at, line in enumerate(sent) if line["purpose"] == "JobSync")
            return [line["text"] for line in sent[:end + 1]]

    def test_does_not_change_what_the_machine_is_sent(self):
        alone = self.run_job(0)
        crowded = self.run_job(100)
        self.assertGreater(len(alone), 100)
        self.assertEqual(alone, crowded)


class Stop(LiveTest):
    def test_acts_at_once_in_a_crowd(self):
        with Daemon("-m", URL) as daemon:
            over = threading.Event()
            start(daemon)
            crowd = [Misbehaviour(daemon.port, seed, over) for seed in range(30)]
            for client in crowd:
                client.start()
            try:
                with Live(daemon.port) as live:
                    live.wait_for(lambda state: MACHINE in state["machines"])
                    self.assertEqual(live.ask(type="command", machine=MACHINE, command="Stop")["outcome"], "Accepted")
                    live.wait_for(lambda state: state["machines"][MACHINE]["job"]["phase"] == "Stopped", timeout=20,
                                  what="the stop")
            finally:
                over.set()
                for client in crowd:
                    client.join(10)


if __name__ == "__main__":
    unittest.main()
