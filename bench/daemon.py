"""What `kerf serve` costs: until it is ready, at rest, and with twenty machines at work on one core."""

import os
import sys
import time

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "tests", "live"))

from daemon import Daemon, Live  # noqa: E402
from kerf_program import VirtualMachine  # noqa: E402

MACHINES = 20
TICKS = os.sysconf("SC_CLK_TCK")


def cpu_s(process):
    with open(f"/proc/{process}/stat", encoding="ascii") as file:
        fields = file.read().rsplit(") ", 1)[1].split()
    return (int(fields[11]) + int(fields[12])) / TICKS


def memory_mb(process):
    with open(f"/proc/{process}/status", encoding="ascii") as file:
        return next(int(line.split()[1]) for line in file if line.startswith("VmRSS")) / 1024


def at_rest(watched, seconds=20):
    with VirtualMachine("grblhal", speed="1") as controller:
        began = time.monotonic()
        with Daemon("-m", controller.url) as daemon:
            ready_ms = (time.monotonic() - began) * 1000
            daemon.wait_until_ready(next(iter(daemon.get("/state")["state"]["machines"])))
            live = Live(daemon.port) if watched else None
            time.sleep(2)
            before = cpu_s(daemon.process.pid)
            if live:
                live.read_for(seconds)
            else:
                time.sleep(seconds)
            share = (cpu_s(daemon.process.pid) - before) / seconds * 100
            who = "one client" if watched else "no client"
            print(f"one idle machine, {who:<11} listening after {ready_ms:4.0f} ms, {share:5.2f} % of a core, "
                  f"{memory_mb(daemon.process.pid):5.1f} MB")


def zigzag(rows):
    lines = ["G21 G90 G94", "G1 F400"]
    for row in range(rows):
        lines += [f"G1 X{10 if row % 2 else 0} Y{row * 0.01:.2f}"]
    return "\n".join(lines + ["M30", ""])


def at_work(seconds=20):
    os.sched_setaffinity(0, {0})
    arguments = [argument for number in range(MACHINES) for argument in ("-m", f"virtual:grblhal?speed=1.{number:02}")]
    with Daemon(*arguments) as daemon:
        os.sched_setaffinity(0, set(range(os.cpu_count())))
        machines = list(daemon.get("/state")["state"]["machines"])
        program = daemon.upload("bench.nc", zigzag(5000))
        for machine in machines:
            daemon.wait_until_ready(machine)
            daemon.command(machine, "Load", program=program)
            daemon.wait_for_machine(machine, lambda view: view.get("program"), what="the program")
            daemon.command(machine, "Start")
        for machine in machines:
            daemon.wait_for_machine(machine, lambda view: "job" in view, timeout=60, what="the job")
        with Live(daemon.port) as live:
            live.read_for(2)
            late = []
            before = cpu_s(daemon.process.pid)
            end = time.monotonic() + seconds
            while time.monotonic() < end:
                frame = live.frame()
                late.append(time.monotonic() - frame["clock_s"])
            share = (cpu_s(daemon.process.pid) - before) / seconds * 100
            running = sum(view["job"]["phase"] == "Running" for view in live.state["machines"].values())
        late = sorted(delay - min(late) for delay in late)
        print(f"{running} machines at work on one core: {share:.0f} % of it, {len(late) / seconds:.0f} patches a "
              f"second; a patch is at the client within {late[len(late) // 2] * 1000:.1f} ms, p99 "
              f"{late[len(late) * 99 // 100] * 1000:.1f} ms, {memory_mb(daemon.process.pid):.1f} MB")


if __name__ == "__main__":
    at_rest(watched=False)
    at_rest(watched=True)
    at_work()
