#!/usr/bin/env python3
"""What `kerf status --watch` costs while nothing happens: processor time and memory, with a machine in another process.

usage: idle_cost.py [KERF] [SECONDS]

Starts `kerf virtual` on a free port of the loopback and watches it for a minute, once on a terminal and once as JSON
lines. Ends with status 1 above the limits. Linux only: it reads /proc.
"""

import os
import pty
import re
import select
import subprocess
import sys
import threading
import time

MOST_PERCENT = 0.5
MOST_MEGABYTES = 20
SETTLE_S = 5


def processor_seconds(pid):
    """Of all threads, in nanoseconds' resolution."""
    total = 0
    for thread in os.listdir(f"/proc/{pid}/task"):
        with open(f"/proc/{pid}/task/{thread}/schedstat", encoding="ascii") as file:
            total += int(file.read().split()[0])
    return total / 1e9


def peak_megabytes(pid):
    with open(f"/proc/{pid}/status", encoding="ascii") as file:
        return int(re.search(r"VmHWM:\s+(\d+) kB", file.read())[1]) / 1024


def start_machine(kerf):
    machine = subprocess.Popen([kerf, "virtual", "--listen", "tcp://127.0.0.1:0", "--speed", "1"],
                               stdout=subprocess.PIPE, text=True)
    for line in machine.stdout:
        found = re.search(r"tcp://127\.0\.0\.1:\d+", line)
        if found:
            return machine, found[0]
    sys.exit("kerf virtual did not start")


def drain(descriptor):
    while True:
        try:
            if select.select([descriptor], [], [], 1)[0] and not os.read(descriptor, 65536):
                return
        except OSError:
            return


def measure(kerf, url, seconds, on_terminal):
    ours, theirs = pty.openpty() if on_terminal else os.pipe()
    watch = subprocess.Popen([kerf, "status", "--watch", "--machine", url], stdin=subprocess.DEVNULL, stdout=theirs)
    os.close(theirs)
    threading.Thread(target=drain, args=(ours,), daemon=True).start()
    time.sleep(SETTLE_S)
    began, spent = time.monotonic(), processor_seconds(watch.pid)
    time.sleep(seconds)
    took = time.monotonic() - began
    percent = 100 * (processor_seconds(watch.pid) - spent) / took
    memory = peak_megabytes(watch.pid)
    watch.terminate()
    watch.wait()
    return percent, memory


def main():
    kerf = sys.argv[1] if len(sys.argv) > 1 else "build/kerf"
    seconds = float(sys.argv[2]) if len(sys.argv) > 2 else 60
    machine, url = start_machine(kerf)
    fits = True
    try:
        for name, on_terminal in (("a terminal", True), ("JSON lines", False)):
            percent, memory = measure(kerf, url, seconds, on_terminal)
            print(f"{name}: {percent:.3f} % of a core, {memory:.1f} MB at most")
            fits = fits and percent < MOST_PERCENT and memory < MOST_MEGABYTES
    finally:
        machine.terminate()
        machine.wait()
    sys.exit(0 if fits else f"more than {MOST_PERCENT} % of a core or {MOST_MEGABYTES} MB")


if __name__ == "__main__":
    main()
