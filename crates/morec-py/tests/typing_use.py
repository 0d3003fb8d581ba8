"""Code of users, for the type checkers; it does not run."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import morec

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt
    import pandas


def use(frame: pandas.DataFrame, array: npt.NDArray[np.float32]) -> float:
    clip: morec.Clip = morec.read(Path("walk.bvh"))
    clips: list[morec.Clip] = morec.read_folder("takes/", progress=False)
    index: morec.Index = morec.train(clips, frame, people={"a": "b"}, background=["idle/", clip])
    index = morec.train("takes/", [("a", "wave", 1.0, 2.0)], params={"rho": 0.4})
    found: morec.Table = index.recognize([clip, "b.bvh"], sensitivity=0.1)
    live = index.recognizer(["hips", "head"], roles={"hips": None})
    for event in live.push(0.0, array):
        print(event["class"])
    with morec.Database("moves.mdb") as db:
        hits: morec.Table = db.search(clip, 10.0, 11.5)
    morec.crossval(clips, frame, by="person").report("report.html")
    for said in morec.listen("vmc://127.0.0.1:39539", index):
        print(said["class"])
    part: npt.NDArray[np.float64] = clip[1.0:2.0].positions
    made = morec.Clip.from_positions(part, clip.names, rate_hz=30)
    values, names = morec.windows(made, frame)
    return float(morec.features(made).values[0, 0]) + len(hits) + len(found) + len(values) + len(names)
