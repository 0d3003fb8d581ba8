"""Plots."""

from __future__ import annotations

import pytest

import morec

matplotlib = pytest.importorskip("matplotlib")
matplotlib.use("Agg")


@pytest.fixture(autouse=True)
def closed() -> None:
    import matplotlib.pyplot as plt

    plt.close("all")


def test_a_timeline_shows_labels_above_detections(
    index: morec.Index, clips: list[morec.Clip], labels: morec.Table
) -> None:
    found = index.recognize(clips)
    ax = morec.plot.timeline(found, labels, clip=clips[0].name)
    here = [row for row in [*labels, *found] if row["clip"] == clips[0].name]
    assert len(ax.collections) == len(here)
    assert [tick.get_text() for tick in ax.get_yticklabels()] == ["found", "labelled"]
    again = morec.plot.timeline([], ax=morec.plot.timeline(found).figure.subplots())
    assert len(again.collections) == 0


def test_a_pose_has_its_bones(clips: list[morec.Clip]) -> None:
    clip = clips[0]
    for view in ("front", "side", "top"):
        ax = morec.plot.skeleton(clip, 1.0, view=view)
        assert len(ax.lines) == len(clip.names) - 1
    points = morec.Clip.from_positions(clip.positions, clip.names, clip.rate_hz)
    assert 10 <= len(morec.plot.skeleton(points, 1e9).lines) <= 14
    with pytest.raises(ValueError, match="view"):
        morec.plot.skeleton(clip, view="below")
    with pytest.raises(ValueError, match="no frames"):
        morec.plot.skeleton(clip[:0.0])


def test_confusion_and_misfit(clips: list[morec.Clip], labels: morec.Table) -> None:
    measured = morec.crossval(clips, labels, by="clip", everyday="never")
    ax = morec.plot.confusion(measured)
    shown = sum(int(text.get_text()) for text in ax.texts)
    assert shown == sum(map(sum, measured.evaluation["confusion"]["counts"]))
    ax = morec.plot.misfit(clips[0])
    cuts = morec.cut(clips[0], method="ppca")["cuts_secs"]
    assert len(ax.lines) == 2 + len(cuts)
