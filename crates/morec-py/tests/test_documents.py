"""The blocks of the guide's chapter and the tutorial run."""

from __future__ import annotations

import json
import re
import warnings
from pathlib import Path

import pytest

import morec

pytest.importorskip("pandas")
pytest.importorskip("sklearn")
matplotlib = pytest.importorskip("matplotlib")
matplotlib.use("Agg")

ROOT = Path(__file__).parents[3]
GUIDE = ROOT / "docs/guide/python.md"
TUTORIAL = Path(__file__).parents[1] / "examples/tutorial.ipynb"
BLOCK = re.compile(r"(<!-- check: none -->\n)?```python\n(.*?)```", re.DOTALL)


@pytest.fixture()
def fixture(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder with the names that the text uses."""
    clips, labels = morec.synth.database(1, people=3, repetitions=2, classes=["wave", "bow"])
    names = {clip.name: f"signals_{number}" for number, clip in enumerate(clips[:2], 1)}
    (tmp_path / "clips").mkdir()
    (tmp_path / "new").mkdir()
    (tmp_path / "background").mkdir()
    for clip in clips[:2]:
        clip.save(tmp_path / "clips" / f"{names[clip.name]}.bvh")
    clips[2].save(tmp_path / "new" / "new_1.bvh")
    morec.synth.everyday(2, clips=1)[0].save(tmp_path / "background" / "idle.bvh")
    lines = ["clip\tclass\tstart_secs\tstop_secs"]
    for row in labels:
        if row["clip"] in names:
            lines.append(f"{names[row['clip']]}\t{row['class']}\t{row['start_secs']}\t{row['stop_secs']}")
    (tmp_path / "labels.tsv").write_text("\n".join(lines) + "\n")
    (tmp_path / "people.tsv").write_text("clip\tperson\nsignals_1\tanna\nsignals_2\tben\n")
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.mark.usefixtures("fixture")
def test_the_guide_runs() -> None:
    text = GUIDE.read_text(encoding="utf-8")
    names: dict[str, object] = {}
    run = 0
    for found in BLOCK.finditer(text):
        if found.group(1) is None:
            line = text[: found.start()].count("\n") + 2
            with warnings.catch_warnings():
                warnings.simplefilter("ignore", morec.MorecWarning)
                exec(compile("\n" * line + found.group(2), str(GUIDE), "exec"), names)
            run += 1
    assert run >= 9


@pytest.mark.usefixtures("fixture")
def test_the_tutorial_runs() -> None:
    notebook = json.loads(TUTORIAL.read_text(encoding="utf-8"))
    names: dict[str, object] = {}
    for cell in notebook["cells"]:
        if cell["cell_type"] == "code":
            exec("".join(cell["source"]), names)


def test_the_licences_are_the_projects() -> None:
    for name in ("LICENSE-MIT", "LICENSE-APACHE"):
        assert (ROOT / name).read_bytes() == (TUTORIAL.parents[1] / name).read_bytes()
