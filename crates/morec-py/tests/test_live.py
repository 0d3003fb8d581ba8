"""Listening to a sender, and stopping."""

from __future__ import annotations

import os
import signal
import socket
import struct
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

import pytest

import morec


def osc(address: str, name: str, *numbers: float) -> bytes:
    def text(value: str) -> bytes:
        raw = value.encode() + b"\0"
        return raw + b"\0" * (-len(raw) % 4)

    return text(address) + text(",s" + "f" * len(numbers)) + text(name) + struct.pack(f">{len(numbers)}f", *numbers)


BONES = {
    "Hips": (0.0, 1.0, 0.0), "Spine": (0.0, 0.1, 0.0), "Chest": (0.0, 0.2, 0.0), "Neck": (0.0, 0.2, 0.0),
    "Head": (0.0, 0.1, 0.0), "LeftUpperArm": (-0.2, 0.1, 0.0), "LeftLowerArm": (-0.3, 0.0, 0.0),
    "LeftHand": (-0.25, 0.0, 0.0), "RightUpperArm": (0.2, 0.1, 0.0), "RightLowerArm": (0.3, 0.0, 0.0),
    "RightHand": (0.25, 0.0, 0.0), "LeftUpperLeg": (-0.1, -0.05, 0.0), "LeftLowerLeg": (0.0, -0.45, 0.0),
    "LeftFoot": (0.0, -0.45, 0.0), "RightUpperLeg": (0.1, -0.05, 0.0), "RightLowerLeg": (0.0, -0.45, 0.0),
    "RightFoot": (0.0, -0.45, 0.0),
}  # fmt: skip


def send(port: int, frames: int) -> None:
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as out:
        for frame in range(frames):
            turn = 0.01 * (frame % 40)
            for name, place in BONES.items():
                packet = osc("/VMC/Ext/Bone/Pos", name, *place, turn, 0.0, 0.0, (1 - turn * turn) ** 0.5)
                out.sendto(packet, ("127.0.0.1", port))
            time.sleep(0.005)


def test_frames_arrive_and_listening_ends(index: morec.Index) -> None:
    with morec.listen("vmc://127.0.0.1:0", index, timeout=0.5) as events:
        port = int(events.address.rsplit(":", 1)[1])
        send(port, 60)
        assert list(events) == []
        # How many depends on the machine: a reader that is late drops old frames.
        assert events.status["frames"] > 0 and events.status["actors"] == 1
    # The port is free again.
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as again:
        again.bind(("127.0.0.1", port))
    assert list(events) == []


def test_what_cannot_be_listened_to(index: morec.Index) -> None:
    with pytest.raises(ValueError, match="vmc://HOST:PORT"):
        morec.listen("http://127.0.0.1:1", index)
    with pytest.raises(OSError, match="expected HOST:PORT"):
        morec.listen("vmc://nowhere", index)
    with pytest.raises(ValueError, match="actors"):
        morec.listen("vmc://127.0.0.1:0", index, actors=0)
    with morec.listen("vmc://127.0.0.1:0", index) as events, pytest.raises(OSError, match="is another program"):
        morec.listen(events.address, index)


def test_ctrl_c_is_clean(index: morec.Index, tmp_path: Path) -> None:
    index.save(tmp_path / "signs.index")
    program = (
        "import signal, sys, morec\n"
        # A shell ignores the signal for what it runs in the background, and Python leaves an ignored signal alone.
        "signal.signal(signal.SIGINT, signal.default_int_handler)\n"
        f"events = morec.listen('vmc://127.0.0.1:0', morec.load({str(tmp_path / 'signs.index')!r}))\n"
        # Within the block: the signal may come as soon as the address is out.
        "try:\n    print(events.address, flush=True)\n    list(events)\n"
        "except KeyboardInterrupt:\n    events.close()\n    print('stopped', flush=True)\n    sys.exit(7)\n"
    )
    child = subprocess.Popen([sys.executable, "-c", program], stdout=subprocess.PIPE, text=True, env={**os.environ})
    assert child.stdout is not None
    port = int(child.stdout.readline().rsplit(":", 1)[1])
    child.send_signal(signal.SIGINT)
    assert child.stdout.read() == "stopped\n" and child.wait() == 7
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as again:
        again.bind(("127.0.0.1", port))


def test_a_performer_over_vmc_is_recognised(
    command: Callable[..., str], index: morec.Index, newcomer: morec.Clip, tmp_path: Path
) -> None:
    whole = index.recognize(newcomer)
    # A quarter of a minute at most, to the end of the first motions.
    part = newcomer[: min(whole[1]["reported_secs"] + 1.0, 15.0)]
    expected = [row["class"] for row in index.recognize(part)]
    assert expected
    part.save(tmp_path / "take.bvh")
    with morec.listen("vmc://127.0.0.1:0", index, timeout=2.0) as events:
        command("send", tmp_path / "take.bvh", "--to", events.address)
        found = list(events)
    assert {event["phase"] for event in found} == {"end"}
    assert [event["class"] for event in found] == expected
