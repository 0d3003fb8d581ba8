"""Synthetic clips, trained once for all tests."""

from __future__ import annotations

import os
import shutil
import subprocess
from collections.abc import Callable
from pathlib import Path

import pytest

import morec

CLASSES = ["wave", "bow", "clap"]


@pytest.fixture(scope="session")
def material() -> tuple[list[morec.Clip], morec.Table]:
    return morec.synth.database(1, people=3, repetitions=2, classes=CLASSES)


@pytest.fixture(scope="session")
def clips(material: tuple[list[morec.Clip], morec.Table]) -> list[morec.Clip]:
    return material[0]


@pytest.fixture(scope="session")
def labels(material: tuple[list[morec.Clip], morec.Table]) -> morec.Table:
    return material[1]


@pytest.fixture(scope="session")
def newcomer() -> morec.Clip:
    made, _ = morec.synth.database(1, people=4, repetitions=2, classes=CLASSES)
    return made[3]


@pytest.fixture(scope="session")
def index(clips: list[morec.Clip], labels: morec.Table) -> morec.Index:
    return morec.train(clips, labels, everyday="never")


@pytest.fixture(scope="session")
def folder(tmp_path_factory: pytest.TempPathFactory, clips: list[morec.Clip]) -> Path:
    """The clips as BVH files."""
    made = tmp_path_factory.mktemp("clips")
    for clip in clips:
        clip.save(made / f"{clip.name}.bvh")
    return made


@pytest.fixture(scope="session")
def labels_tsv(tmp_path_factory: pytest.TempPathFactory, labels: morec.Table) -> Path:
    path = tmp_path_factory.mktemp("labels") / "labels.tsv"
    lines = ["\t".join(labels.columns)]
    lines += ["\t".join(str(row[name]) for name in labels.columns) for row in labels]
    path.write_text("\n".join(lines) + "\n")
    return path


@pytest.fixture(scope="session")
def command() -> Callable[..., str]:
    """The command `morec`: of MOREC_COMMAND, or of this workspace's last build."""
    target = Path(__file__).resolve().parents[3] / "target"
    builds = [path for path in (target / "release/morec", target / "debug/morec") if path.is_file()]
    builds.sort(key=lambda path: path.stat().st_mtime, reverse=True)
    found = [os.environ.get("MOREC_COMMAND"), *builds, shutil.which("morec")]
    binary = next((str(path) for path in found if path and Path(path).is_file()), None)
    if binary is None:
        pytest.skip("no command morec: build it, or name it in MOREC_COMMAND")

    def run(*args: object) -> str:
        environment = {**os.environ, "SOURCE_DATE_EPOCH": "1700000000"}
        done = subprocess.run([binary, *map(str, args)], capture_output=True, text=True, env=environment, check=False)
        assert done.returncode == 0, done.stderr
        return done.stdout

    return run
