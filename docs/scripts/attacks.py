"""Attacks every door of `morec live` on this machine, and reports the most memory it took and what it still recognised.

    python3 docs/scripts/attacks.py target/release/morec INDEX CLIP [SECS]

CLIP has motions of INDEX; it is played by a good sender while each attack goes on, for SECS seconds at least (20). A line each:
the attack, the most memory of the process (VmHWM), motions recognised of those that are recognised in peace, the exit code at
Ctrl-C. The exit code is 1 if memory is above 64 MB or the process ended by itself.
"""

import base64
import json
import os
import random
import re
import signal
import socket
import struct
import subprocess
import sys
import tempfile
import threading
import time
from pathlib import Path

LEAST = 64 << 20


def packed(text):
    """An OSC string."""
    return text.encode() + bytes(4 - len(text) % 4)


def bone(name, shift=0.0):
    """An OSC message of VMC's that places a bone."""
    return packed("/VMC/Ext/Bone/Pos") + packed(",sfffffff") + packed(name) + struct.pack(">7f", shift, 1, 0, 0, 0, 0, 1)


BODY = ["Hips", "Spine", "Head", "LeftUpperLeg", "RightUpperLeg", "LeftLowerLeg", "RightLowerLeg", "LeftUpperArm", "RightUpperArm"]


def bundle(messages):
    return b"#bundle\0" + bytes(7) + b"\1" + b"".join(struct.pack(">i", len(m)) + m for m in messages)


class Live:
    """`morec live` with a source and perhaps a sink."""

    def __init__(self, morec, index, listen, *more):
        self.events = tempfile.NamedTemporaryFile(suffix=".jsonl", delete=False)
        self.process = subprocess.Popen(
            [morec, "live", index, "--listen", listen, "--emit", f"json:{self.events.name}", "--quiet", *more],
            stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True,
        )
        self.said = []
        listening = threading.Event()
        threading.Thread(target=self.read, args=(listening,), daemon=True).start()
        if not listening.wait(30):
            raise SystemExit("it does not listen")
        self.at = next(re.search(r"listening to \S+//([^\s]+)", line)[1] for line in self.said if "listening to" in line)

    def read(self, listening):
        for line in self.process.stderr:
            self.said.append(line.rstrip())
            if "listening to" in line:
                listening.set()

    @property
    def address(self):
        host, port = self.at.rsplit(":", 1)
        return host, int(port)

    def memory(self):
        """The most that it has taken, bytes."""
        try:
            status = Path(f"/proc/{self.process.pid}/status").read_text()
        except OSError:
            return 0
        found = re.search(r"VmHWM:\s+(\d+) kB", status)
        return int(found[1]) * 1024 if found else 0

    def ended(self):
        lines = Path(self.events.name).read_text().splitlines()
        return sum(json.loads(line)["phase"] == "end" for line in lines)

    def stop(self):
        memory, alive = self.memory(), self.process.poll() is None
        if alive:
            self.process.send_signal(signal.SIGINT)
        code = self.process.wait(30)
        ends = self.ended()
        os.unlink(self.events.name)
        return memory, ends, code if alive else f"ended by itself: {code}"


class Siege:
    def __init__(self, morec, index, clip, secs):
        self.morec, self.index, self.clip, self.secs = morec, index, clip, secs
        self.worst = 0
        self.failed = False
        with tempfile.NamedTemporaryFile(suffix=".jsonl") as out:
            subprocess.run([morec, "record", "--listen", f"clip://{clip}?speed=0", "-o", out.name, "--overwrite", "--count-down", "0"],
                           check=True, capture_output=True, stdin=subprocess.DEVNULL)
            self.lines = Path(out.name).read_bytes().splitlines(keepends=True)

    # Good senders.

    def vmc(self, live):
        subprocess.run([self.morec, "send", self.clip, "--to", f"vmc://{live.at}"], capture_output=True)

    def json(self, live):
        """The lines of the clip at their times; connects again where it is refused, and goes on."""
        begun, to = time.monotonic(), socket.create_connection(live.address)
        for line in self.lines:
            wait = json.loads(line)["t"] - (time.monotonic() - begun)
            if wait > 0:
                time.sleep(wait)
            try:
                to.sendall(line)
            except OSError:
                to.close()
                to = socket.create_connection(live.address)
        to.close()

    # What is done to it.

    def siege(self, name, listen, good, attack, more=(), senders=1):
        live = Live(self.morec, self.index, listen, *more)
        stop = threading.Event()
        attackers = [threading.Thread(target=self.until, args=(attack, live, stop, n), daemon=True) for n in range(2 if attack else 0)]
        for thread in attackers:
            thread.start()
        begun = time.monotonic()
        time.sleep(1)
        players = [threading.Thread(target=good, args=(live,)) for _ in range(senders)]
        for thread in players:
            thread.start()
        for thread in players:
            thread.join()
        time.sleep(max(1, self.secs - (time.monotonic() - begun)) if attack else 1)
        stop.set()
        for thread in attackers:
            thread.join(35)
        memory, ends, code = live.stop()
        self.worst = max(self.worst, memory)
        self.failed |= memory > LEAST or code != 0
        named = [line for line in live.said if "too, and all" in line]
        print(f"{name}\t{memory / 1e6:.1f} MB\t{ends} motions\texit {code}{'; ' + named[0] if named else ''}", flush=True)
        return ends

    def until(self, attack, live, stop, number):
        rng = random.Random(number)
        while not stop.is_set() and live.process.poll() is None:
            try:
                attack(live, stop, rng)
            except OSError:
                time.sleep(0.01)


def udp():
    return socket.socket(socket.AF_INET, socket.SOCK_DGRAM)


# Each goes on for a moment and is begun again until time is over.


def a_byte_now_and_then(live, stop, rng):
    with udp() as to:
        while not stop.is_set():
            to.sendto(b"x", live.address)
            time.sleep(0.5)


def random_datagrams(live, stop, rng):
    kinds = [rng.randbytes(rng.randrange(1, 1400)) for _ in range(64)] + [b"#bundle\0" + bytes(8) + rng.randbytes(400)]
    with udp() as to:
        for _ in range(5000):
            to.sendto(rng.choice(kinds), live.address)


def from_many_ports(live, stop, rng):
    for _ in range(200):
        with udp() as to:
            to.sendto(bone(rng.choice(BODY)), live.address)
            to.sendto(b"x", live.address)


def bodies_from_many_ports(live, stop, rng):
    sockets = [udp() for _ in range(32)]
    for step in range(100):
        for to in sockets:
            to.sendto(bundle([bone(name, step / 100) for name in BODY]), live.address)
        time.sleep(0.01)
    for to in sockets:
        to.close()


def largest_bundles(live, stop, rng):
    full = bundle([bone(name) for name in BODY * 80])[:65_000]
    with udp() as to:
        for _ in range(200):
            to.sendto(full, live.address)
            to.sendto(b"#bundle\0" * 8000, live.address)


def idle_connections(live, stop, rng):
    held = []
    for _ in range(64):
        held.append(socket.create_connection(live.address, timeout=1))
    # A byte now and then does not keep them.
    for _ in range(70):
        if stop.is_set():
            break
        for to in held:
            try:
                to.send(b" ")
            except OSError:
                pass
        time.sleep(0.5)
    for to in held:
        to.close()


def many_names(live, stop, rng):
    with socket.create_connection(live.address, timeout=1) as to:
        for number in range(2000):
            line = {"actor": number % 65536, "positions": {"hips": [0, 1, 0], "left_thigh": [0.1, 1, 0], "right_thigh": [-0.1, 1, 0]}}
            to.sendall(json.dumps(line).encode() + b"\n")


def long_lines(live, stop, rng):
    with socket.create_connection(live.address, timeout=1) as to:
        line = b'{"positions": {"' + b"x" * 65_000 + b'": [0,0,0]}}\n'
        for _ in range(500):
            to.sendall(line)


def no_line_end(live, stop, rng):
    with socket.create_connection(live.address, timeout=1) as to:
        for _ in range(500):
            to.sendall(b"[" * 65_536)


def many_long_lines(live, stop, rng):
    held = [socket.create_connection(live.address, timeout=1) for _ in range(6)]
    line = b'{"note": [' + b"1," * 32_000 + b'1], "positions": {"hips": [0,1,0]}}\n'
    for _ in range(100):
        for to in held:
            to.sendall(line)
    for to in held:
        to.close()


HELLO = (
    "GET / HTTP/1.1\r\nHost: a\r\nUpgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: 13\r\n"
    f"Sec-WebSocket-Key: {base64.b64encode(bytes(16)).decode()}\r\n\r\n"
).encode()


def websocket(port):
    return socket.create_connection(("127.0.0.1", port), timeout=1)


def at_websocket(port):
    """Attacks on the listeners' door."""

    def half_open(live, stop, rng):
        held = [websocket(port) for _ in range(200)]
        for to in held:
            to.send(b"G")
        time.sleep(0.5)
        for to in held:
            to.close()

    def huge_messages(live, stop, rng):
        with websocket(port) as to:
            to.sendall(HELLO)
            to.recv(1000)
            to.sendall(b"\x81\xff" + struct.pack(">Q", 64 << 20) + bytes(4))
            for _ in range(1024):
                to.sendall(bytes(65_536))

    def endless_hello(live, stop, rng):
        with websocket(port) as to:
            to.sendall(b"GET / HTTP/1.1\r\n")
            for number in range(100_000):
                to.sendall(b"X-%d: " % number + b"x" * 1000 + b"\r\n")

    def deaf_listeners(live, stop, rng):
        held = []
        for _ in range(32):
            to = websocket(port)
            to.sendall(HELLO)
            held.append(to)
        for _ in range(10):
            for to in held:
                # Pings, whose answers nobody takes.
                to.sendall((b"\x89\xfd" + bytes(4) + bytes(125)) * 50)
            time.sleep(0.1)
        for to in held:
            to.close()

    return {"half-open connections": half_open, "messages of 64 MB": huge_messages, "a hello without end": endless_hello,
            "32 listeners that do not listen": deaf_listeners}


def main():
    morec, index, clip, *rest = sys.argv[1:]
    siege = Siege(morec, index, clip, float(rest[0]) if rest else 20.0)
    vmc, lines = "vmc://127.0.0.1:0", "json+tcp://127.0.0.1:0"
    siege.siege("VMC in peace", vmc, siege.vmc, None)
    siege.siege("VMC: a byte twice a second, one place", vmc, siege.vmc, a_byte_now_and_then, ["--actors", "1"])
    siege.siege("VMC: two senders at once", vmc, siege.vmc, None, senders=2)
    siege.siege("VMC: two senders at once, one place", vmc, siege.vmc, None, ["--actors", "1"], senders=2)
    for attack in [random_datagrams, from_many_ports, bodies_from_many_ports, largest_bundles]:
        siege.siege(f"VMC: {attack.__name__.replace('_', ' ')}", vmc, siege.vmc, attack)
    siege.siege("JSON in peace", lines, siege.json, None)
    for attack in [idle_connections, many_names, long_lines, no_line_end, many_long_lines]:
        siege.siege(f"JSON: {attack.__name__.replace('_', ' ')}", lines, siege.json, attack)
    for name in at_websocket(0):
        with socket.socket() as free:
            free.bind(("127.0.0.1", 0))
            port = free.getsockname()[1]
        attack = at_websocket(port)[name]
        siege.siege(f"WebSocket: {name}", vmc, siege.vmc, attack, ["--emit", f"ws://127.0.0.1:{port}"])
    print(f"most\t{siege.worst / 1e6:.1f} MB")
    return siege.failed


if __name__ == "__main__":
    sys.exit(main())
