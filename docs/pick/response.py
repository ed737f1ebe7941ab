#!/usr/bin/env python3
"""Measures how fast neve pick answers: a page that clicks, and counts what it is shown.

    docs/pick/response.py NEVE SCENE FOLDER [ROUNDS]

Prints, for each click: the time to the next picture, to the first tile of the next round, to all nine (a run
has ended, its tile moves with the next picture, 0.2 s later at most), the pictures a second meanwhile, and the
memory that the processes take.
"""
import base64
import json
import os
import pathlib
import re
import select
import signal
import socket
import struct
import subprocess
import sys
import time

AXES = ["material.snow.youngs_modulus=2e4,1e6", "material.snow.hardening=2,20",
        "material.snow.critical_compression=5e-3,8e-2", "material.snow.critical_stretch=1e-3,3e-2"]
RUNS = ["--coarsen", "2", "--frames", "24"]


class Page:
    """The page's side of the web socket: shows every picture at once."""

    def __init__(self, address):
        host, port, token = re.match(r"http://([^:/]+):(\d+)/\?token=(.*)", address).groups()
        self.socket = socket.create_connection((host, int(port)))
        key = base64.b64encode(os.urandom(16)).decode()
        self.socket.sendall(
            f"GET /ws?token={token} HTTP/1.1\r\nHost: {host}:{port}\r\nOrigin: http://{host}:{port}\r\n"
            f"Upgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: 13\r\n"
            f"Sec-WebSocket-Key: {key}\r\n\r\n".encode())
        self.bytes = b""
        while b"\r\n\r\n" not in self.bytes:
            self.bytes += self.socket.recv(65536)
        head, self.bytes = self.bytes.split(b"\r\n\r\n", 1)
        assert b" 101 " in head, head
        self.pictures = []  # times of arrival
        self.send("s 1280 800 1")
        self.send("v 1")

    def send(self, text):
        data, mask = text.encode(), os.urandom(4)
        self.socket.sendall(bytes([0x81, 0x80 | len(data)]) + mask +
                            bytes(b ^ mask[k % 4] for k, b in enumerate(data)))

    def take(self):
        """One whole message of the program, if there is one."""
        if len(self.bytes) < 2:
            return False
        length, start = self.bytes[1] & 127, 2
        if length >= 126:
            size, kind = (2, ">H") if length == 126 else (8, ">Q")
            if len(self.bytes) < 2 + size:
                return False
            length, start = struct.unpack(kind, self.bytes[2:2 + size])[0], 2 + size
        if len(self.bytes) < start + length:
            return False
        payload, opcode = self.bytes[start:start + length], self.bytes[0] & 15
        self.bytes = self.bytes[start + length:]
        if opcode == 2:
            self.pictures.append(time.monotonic())
            self.send(f"a {struct.unpack('<I', payload[:4])[0]}")
        return True

    def look(self, seconds):
        if select.select([self.socket], [], [], seconds)[0]:
            self.bytes += self.socket.recv(1 << 20)
        while self.take():
            pass


def ended(folder, earlier):
    """Runs of the round that have ended."""
    try:
        runs = json.loads((folder / "manifest.json").read_text())["runs"]
    except (OSError, ValueError):
        return []
    if [run["key"] for run in runs] == earlier:
        return []
    states = []
    for run in runs:
        try:
            status = json.loads((folder / "runs" / run["folder"] / "status.json").read_text())
        except (OSError, ValueError):
            continue
        if status["key"] == run["key"] and status["state"] not in ("pending", "running", "interrupted"):
            states.append(run["key"])
    return states


def keys_of(folder):
    try:
        return [run["key"] for run in json.loads((folder / "manifest.json").read_text())["runs"]]
    except (OSError, ValueError):
        return None


def memory_of(pid):
    """MiB of a process; shared libraries count in each."""
    try:
        text = pathlib.Path(f"/proc/{pid}/status").read_text()
    except OSError:
        return 0
    found = re.search(r"VmRSS:\s+(\d+)", text)
    return int(found[1]) / 1024 if found else 0


def tree_of(pid):
    """A process and all below it."""
    try:
        children = pathlib.Path(f"/proc/{pid}/task/{pid}/children").read_text().split()
    except OSError:
        children = []
    return [pid] + [one for child in children for one in tree_of(child)]


def main():
    neve, scene, folder = sys.argv[1], sys.argv[2], pathlib.Path(sys.argv[3])
    rounds = int(sys.argv[4]) if len(sys.argv) > 4 else 3
    axes = [part for axis in AXES for part in ("-p", axis)]
    folder.parent.mkdir(parents=True, exist_ok=True)
    program = subprocess.Popen([neve, "pick", scene, *axes, *RUNS, "--web", "--out", folder],
                               stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    address = None
    while not address:
        address = re.search(r"http://\S+", program.stdout.readline())
    page = Page(address[0])
    clicked, earlier = time.monotonic(), None
    for number in range(1, rounds + 1):
        first, own, tree = None, 0, 0
        page.pictures.clear()
        while True:
            page.look(0.01)
            done = ended(folder, earlier)
            own = max(own, memory_of(program.pid))
            tree = max(tree, sum(map(memory_of, tree_of(program.pid))))
            # The favourite is a run of the round before.
            if len(done) > (1 if earlier else 0) and not first:
                first = time.monotonic() - clicked
            if len(done) == 9:
                break
        all_nine = time.monotonic() - clicked
        shown = [t - clicked for t in page.pictures if t > clicked]
        print(f"round {number}: next picture after {1000 * min(shown):.0f} ms, first tile {first:.1f} s, "
              f"all nine {all_nine:.1f} s, {len(shown) / all_nine:.0f} pictures/s; at most {own:.0f} MiB in "
              f"this process, {tree:.0f} MiB with its runs", flush=True)
        earlier, until = keys_of(folder), time.monotonic() + 3
        page.pictures.clear()
        while time.monotonic() < until:
            page.look(0.05)
        print(f"  while nobody answers: {len(page.pictures) / 3:.0f} pictures/s", flush=True)
        page.send(f"k {ord('1') + number} 1 0")
        page.send(f"k {ord('1') + number} 0 0")
        clicked = time.monotonic()
    program.send_signal(signal.SIGINT)
    program.wait()


main()
