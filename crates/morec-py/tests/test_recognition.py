"""Training, recognition, streams and measures."""

from __future__ import annotations

import pickle
import threading
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import morec


def spans(rows: Any) -> list[tuple[str, float, float]]:
    return [(row["class"], row["start_secs"], row["stop_secs"]) for row in rows]


def test_a_newcomer_is_recognised(index: morec.Index, newcomer: morec.Clip) -> None:
    found = index.recognize(newcomer)
    columns = ["clip", "class", "start_secs", "stop_secs", "score", "reported_secs", "repetitions", "period_secs"]
    assert found.columns == columns
    assert len(found) >= 3 and {row["clip"] for row in found} == {newcomer.name}
    for row in found:
        assert row["class"] in index.class_names and 0 <= row["score"] <= 1
        assert row["start_secs"] < row["stop_secs"] <= row["reported_secs"]


def test_how_well_a_motion_was_performed(index: morec.Index, newcomer: morec.Clip) -> None:
    found = index.recognize(newcomer, deviation=True)
    assert found.columns[-1] == "deviation" and "deviation" not in index.recognize(newcomer).columns
    for row in found:
        deviation = row["deviation"]
        assert 0 < deviation["off_degrees"] < 90 and deviation["pace"] > 0.3
        assert deviation["bones"][0]["off_degrees"] >= deviation["bones"][-1]["off_degrees"]


def test_several_clips_and_paths(index: morec.Index, clips: list[morec.Clip], folder: Path) -> None:
    each = [row for clip in clips for row in index.recognize(clip)]
    assert index.recognize(clips) == each
    # Text rounds what files hold.
    from_files = index.recognize(folder)
    assert [row["class"] for row in from_files] == [row["class"] for row in sorted(each, key=lambda row: row["clip"])]
    with pytest.raises(TypeError, match="expected clips or paths"):
        index.recognize([3])  # type: ignore[list-item]


def test_an_index_is_saved_loaded_and_pickled(index: morec.Index, tmp_path: Path) -> None:
    path = tmp_path / "signs.index"
    index.save(path)
    assert path.read_bytes() == index.to_bytes() and [p.name for p in tmp_path.iterdir()] == ["signs.index"]
    for again in (morec.load(path), pickle.loads(pickle.dumps(index)), morec.Index.from_bytes(index.to_bytes())):
        assert again == index and again.to_bytes() == index.to_bytes() and again.report is None
    assert index.report is not None and index.report["classes"] == index.classes
    assert index.method == "templates" and index.provenance["samples"] == 18
    assert "bow" in repr(index)
    with pytest.raises(FileNotFoundError):
        morec.load(tmp_path / "nowhere.index")
    (tmp_path / "broken.index").write_bytes(path.read_bytes()[:-7])
    with pytest.raises(morec.MorecError, match="broken.index"):
        morec.load(tmp_path / "broken.index")
    with pytest.raises(FileNotFoundError):
        index.save(tmp_path / "nowhere" / "signs.index")


def test_labels_come_in_any_form(clips: list[morec.Clip], labels: morec.Table, labels_tsv: Path, index: morec.Index) -> None:
    people = {row["clip"]: row["person"] for row in labels}
    tuples = [(row["clip"], row["class"], row["start_secs"], row["stop_secs"]) for row in labels]
    forms: list[dict[str, Any]] = [
        {"labels": labels.to_pandas()},
        {"labels": tuples, "people": people},
        {"labels": labels_tsv},
        {"labels": [{key: row[key] for key in row if key != "person"} for row in labels], "people": people},
    ]
    for form in forms:
        again = morec.train(clips, everyday="never", **form)
        assert again.classes == index.classes
        assert spans(again.recognize(clips[0])) == spans(index.recognize(clips[0]))


def test_labels_that_make_no_sense_are_plain_errors(clips: list[morec.Clip], tmp_path: Path) -> None:
    name = clips[0].name
    for labels, text in [
        ([(name, "wave", 2.0, 1.0)], "row 0: expected a stop after the start, found 2.0 to 1.0"),
        ([(name, "wave", 2.0)], "expected .clip, class"),
        ([{"clip": name}], "expected the columns clip and class"),
        ([{"clip": name, "class": "wave", "start": 1.5, "stop": 3}], "seconds are start_secs"),
        ([(name, "wave", "early", "late")], "expected a start and a stop"),
        (None, "expected a DataFrame"),
    ]:
        with pytest.raises(ValueError, match=text):
            morec.train(clips, labels)
    with pytest.raises(FileNotFoundError):
        morec.train(clips, tmp_path / "labels.tsv")
    (tmp_path / "labels.tsv").write_text("clip\tclass\tstart\tstop\nA\twave\tx\t3\n")
    with pytest.raises(morec.MorecError, match="labels: line 2"):
        morec.train(clips, tmp_path / "labels.tsv")
    with pytest.raises(morec.MorecError, match="no sample to train on"):
        morec.train(clips, [("nobody", "wave", 1.0, 2.0)])
    with pytest.raises(FileNotFoundError, match="none of the clips is called so"):
        morec.train(clips, [(name, "wave", 1.0, 2.0)], background=["nobody"])
    for option, value in [("method", "magic"), ("everyday", "often"), ("unlabelled", "x"), ("svrdm", "x")]:
        with pytest.raises(ValueError, match=option):
            morec.train(clips, [(name, "wave", 1.0, 2.0)], **{option: value})  # type: ignore[arg-type]
    with pytest.raises(ValueError, match="no parameter is called nothing"):
        morec.train(clips, [(name, "wave", 1.0, 2.0)], params={"nothing": 3})


def test_what_is_left_out_is_warned_of(clips: list[morec.Clip], labels: morec.Table) -> None:
    with pytest.warns(morec.MorecWarning) as caught:
        morec.train(clips, [*labels[:10], (labels[0]["clip"], "wave", 1e4, 1e4 + 1)], everyday="never")
    texts = [str(warning.message) for warning in caught]
    assert any("left out" in text for text in texts), texts


def test_progress_is_told_and_may_stop_training(clips: list[morec.Clip], labels: morec.Table) -> None:
    told: list[tuple[str, int, int]] = []
    morec.train(clips, labels, everyday="never", progress=lambda *args: told.append(args))
    assert told[-1] == ("", 0, 0)

    def stop(stage: str, done: int, total: int) -> None:
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        morec.train(clips, labels, progress=stop)


def test_a_stream_gives_what_its_clip_gives(index: morec.Index, newcomer: morec.Clip) -> None:
    whole = spans(index.recognize(newcomer))
    for dtype in (np.float64, np.float32):
        live = index.recognizer(newcomer)
        positions = newcomer.positions.astype(dtype)
        found = []
        for frame, pose in enumerate(positions):
            found += live.push(frame / newcomer.rate_hz, pose)
        found += live.finish()
        assert [row[0] for row in spans(found)] == [row[0] for row in whole]
        if dtype is np.float64:
            assert spans(found) == whole
    live = index.recognizer(newcomer)
    times = np.arange(newcomer.frames) / newcomer.rate_hz
    assert spans(live.push_all(times, newcomer.positions) + live.finish()) == whole


def test_a_stream_of_named_joints_in_another_frame(index: morec.Index, newcomer: morec.Clip) -> None:
    whole = spans(index.recognize(newcomer))
    named = morec.normalize(newcomer, dtype=np.float64)
    known = [role for role in morec.ROLES if role in newcomer.roles]
    points = named[:, [morec.ROLES.index(role) for role in known]]
    times = np.arange(newcomer.frames) / newcomer.rate_hz
    live = index.recognizer(known)
    assert spans(live.push_all(times, points) + live.finish()) == whole
    # Z up, in millimetres; rows that are every other of a larger array.
    upright = np.stack([points[..., 0], -points[..., 2], points[..., 1]], axis=-1) * 1000.0
    doubled = np.repeat(upright, 2, axis=1)[:, ::2]
    live = index.recognizer(known, up="z")
    found = [row for frame, pose in enumerate(doubled) for row in live.push(times[frame], pose)]
    assert [row[0] for row in spans(found + live.finish())] == [row[0] for row in whole]
    strange = [f"J{number}" for number in range(len(known))]
    live = index.recognizer(strange, roles={role: strange[at] for at, role in enumerate(known)})
    assert spans(live.push_all(times, points) + live.finish()) == whole


def test_streams_refuse_what_makes_no_sense(index: morec.Index, newcomer: morec.Clip) -> None:
    live = index.recognizer(newcomer)
    joints = len(newcomer.names)
    with pytest.raises(ValueError, match=rf"shape \({joints}, 3\), found \(2, 3\)"):
        live.push(0.0, np.zeros((2, 3)))
    with pytest.raises(ValueError, match="found"):
        live.push(0.0, np.zeros(3))
    with pytest.raises((ValueError, TypeError)):
        live.push(0.0, "nothing")
    with pytest.raises(TypeError):
        live.push("now", np.zeros((joints, 3)))  # type: ignore[arg-type]
    with pytest.raises(ValueError, match="found"):
        live.push_all([0.0], np.zeros((2, joints, 3)))
    for wrong in (np.nan, np.inf, -1e300):
        assert live.push(wrong, np.full((joints, 3), wrong)) == []
    with pytest.raises(ValueError, match="a known set of points"):
        index.recognizer(["a", "b", "c"])
    with pytest.raises(ValueError, match="a joint of the skeleton"):
        index.recognizer(["a", "b", "c"], roles={"hips": "z"})
    with pytest.raises(ValueError, match="up:"):
        index.recognizer(newcomer, up="sideways")
    with pytest.raises(ValueError, match="sensitivity"):
        index.recognizer(newcomer, sensitivity=-1.0)
    with pytest.raises(ValueError, match="performer=nobody.*expected one of `auto`, `teacher`, `anyone`$"):
        index.recognize(newcomer, performer="nobody")  # type: ignore[arg-type]


def test_threads_share_an_index_and_a_recogniser(index: morec.Index, newcomer: morec.Clip) -> None:
    whole = spans(index.recognize(newcomer))
    results: dict[int, Any] = {}

    def work(number: int) -> None:
        live = index.recognizer(newcomer)
        found = live.push_all(np.arange(newcomer.frames) / newcomer.rate_hz, newcomer.positions)
        results[number] = spans(found + live.finish())

    threads = [threading.Thread(target=work, args=(number,)) for number in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert results == dict.fromkeys(range(4), whole)
    # One recogniser pushed to by several: no order is promised, and nothing breaks.
    live = index.recognizer(newcomer)

    def push(number: int) -> None:
        for frame in range(number, 400, 2):
            live.push(frame / newcomer.rate_hz, newcomer.positions[frame])

    threads = [threading.Thread(target=push, args=(number,)) for number in range(2)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    live.finish()


def test_a_stream_has_the_options_and_events_of_listen(
    index: morec.Index, newcomer: morec.Clip, tmp_path: Path
) -> None:
    times = np.arange(newcomer.frames) / newcomer.rate_hz

    def events(**options: Any) -> list[dict[str, Any]]:
        live = index.recognizer(newcomer, **options)
        found = live.push_all(times, newcomer.positions)
        assert 0.0 < live.latency_secs < 1.0 and all(isinstance(one, str) for one in live.diagnosis())
        return found + live.finish()

    plain = events()
    assert plain and {one["phase"] for one in plain} == {"end"}
    told = events(tentative=True)
    assert [one for one in told if one["phase"] == "end"] != [] and any(one["phase"] == "start" for one in told)
    assert all(0 <= one["progress"] <= 1 and one["class"] in index.class_names for one in told)
    assert [one["sequence"] for one in told] == list(range(1, len(told) + 1))
    assert len(events(refractory_secs=1000)) < len(plain)
    newcomer.save(tmp_path / "newcomer.bvh")
    with morec.listen(f"clip://{tmp_path}/newcomer.bvh?speed=0", index) as heard:
        assert set(next(heard)) == set(plain[0])
    with pytest.raises(ValueError, match="early: unknown field"):
        index.recognizer(newcomer, early=True)  # type: ignore[call-arg]
    with pytest.raises(ValueError, match="refractory_secs: expected 0 to 3600"):
        index.recognizer(newcomer, refractory_secs=-1)
    with pytest.raises(ValueError, match="performer: "):
        morec.listen("json+tcp://127.0.0.1:0", index, performer="nobody")  # type: ignore[arg-type]


def test_cross_validation_measures_and_reports(
    clips: list[morec.Clip], labels: morec.Table, tmp_path: Path
) -> None:
    measured = morec.crossval(clips, labels, by="person", everyday="never", perturb=["mirror"])
    assert measured.accuracy is not None and 0 <= measured.accuracy <= 1
    assert len(measured.truth) == len(labels) and len(measured.folds) == 3
    assert list(measured.perturbed) == ["mirror"]
    path = tmp_path / "report.html"
    measured.report(path)
    assert path.read_text().startswith("<!DOCTYPE html>")
    again = morec.evaluate(measured.truth, measured.found, clips)
    assert again["thesis"] == measured.evaluation["thesis"]
    assert "by person" in repr(measured)
    with pytest.raises(ValueError, match="by=shoe: .*expected one of"):
        morec.crossval(clips, labels, by="shoe")
    with pytest.raises(ValueError, match="perturb=.*louder"):
        morec.crossval(clips, labels, perturb=["louder"])


def test_detections_are_measured_in_any_form(
    index: morec.Index, clips: list[morec.Clip], labels: morec.Table, newcomer: morec.Clip, tmp_path: Path
) -> None:
    found = [row for clip in clips for row in index.recognize(clip)]
    measured = morec.evaluate(labels, found, clips, index=index)
    secs = {clip.name: clip.duration_secs for clip in clips}
    assert morec.evaluate(labels, found, secs)["thesis"] == measured["thesis"]
    assert len(measured["missed"]) == measured["totals"]["samples"] - measured["events"]["matched"]
    path = tmp_path / "found.tsv"
    columns = ["clip", "class", "start_secs", "stop_secs", "score", "reported_secs"]
    lines = ["\t".join(columns)] + ["\t".join(str(row[name]) for name in columns) for row in found]
    path.write_text("\n".join(lines) + "\n")
    assert morec.evaluate(labels, path, secs)["thesis"] == measured["thesis"]
    one = morec.evaluate(labels, found, clips, unknown=[newcomer], classes=["wave"])
    assert one["totals"]["samples"] == sum(row["class"] == "wave" for row in labels)
    assert one["unknown"]["clips"] == 1
    label = {"clip": "x", "class": "a", "start_secs": 0, "stop_secs": 1}
    with pytest.raises(ValueError, match="nothing to measure"):
        morec.evaluate([label], [], {"y": 3.0})
    with pytest.raises(ValueError, match="did you mean `wave`"):
        morec.evaluate(labels, found, secs, classes=["wvae"])
    with pytest.raises(ValueError, match="dict of lengths"):
        morec.evaluate(labels, found, secs, index=index)


def test_tables_are_lists_and_frames(index: morec.Index, newcomer: morec.Clip) -> None:
    import pandas

    found = index.recognize(newcomer)
    assert list(found.to_pandas().columns) == found.columns and len(pandas.DataFrame(found)) == len(found)
    assert found.column("class") == [row["class"] for row in found]
    nothing = index.recognize(newcomer[0.0:0.3])
    assert len(nothing) == 0 and list(nothing.to_pandas().columns) == found.columns
    assert pickle.loads(pickle.dumps(found)) == found
    assert "<table>" in found._repr_html_() and "class" in repr(found)
    with pytest.raises(KeyError, match="no column is called"):
        found.column("nothing")


def test_annotators_are_compared_and_time_is_divided() -> None:
    ann = [("one", "walk", 0.0, 4.0), ("one", "jump", 6.0, 10.0), ("hers", "walk", 0.0, 1.0)]
    ben = [("one", "walk", 0.0, 3.0), ("one", "jump", 6.0, 10.0)]
    secs = {"one": 10.0, "hers": 1.0}
    with pytest.warns(morec.MorecWarning, match="a alone labels hers"):
        agreement = morec.agree(ann, ben, secs, time_unit=1.0)
    assert agreement["time"]["observed"] == 0.9
    metrics = pytest.importorskip("sklearn.metrics")
    of_ann = ["walk"] * 4 + ["none"] * 2 + ["jump"] * 4
    of_ben = ["walk"] * 3 + ["none"] * 3 + ["jump"] * 4
    assert agreement["time"]["kappa"] == pytest.approx(metrics.cohen_kappa_score(of_ann, of_ben))
    assert agreement["events"]["matched"] == 2
    with pytest.raises(ValueError, match="no clip is labelled by both"), pytest.warns(morec.MorecWarning):
        morec.agree(ann[2:], ben, secs)
    with pytest.raises(ValueError, match="time_unit"):
        morec.agree(ann, ben, secs, time_unit=0.0)

    budget = morec.budget(ann, secs, people={"one": "ann"})
    assert (budget["clips"], budget["secs"], budget["unlabelled_secs"]) == (2, 11.0, 2.0)
    assert [(c["class"], c["count"], c["total_secs"]) for c in budget["classes"]] == [("jump", 1, 4.0), ("walk", 2, 5.0)]
    assert budget["people"][0]["classes"][0]["share"] == 0.4
    assert budget["transitions"]["counts"] == [[0, 0], [1, 0]]


def test_more_samples_are_worth_something(clips: list[morec.Clip], labels: morec.Table) -> None:
    curve = morec.learning_curve(clips, labels, by="clip", everyday="never")
    assert curve["points"][0]["samples"] == 1 and curve["points"][-1]["samples"] is None
    assert all(0.0 <= draw["f1"] <= 1.0 for point in curve["points"] for draw in point["draws"])
    assert curve["advice"]
