"""The gestures by person: the figure of docs/figures.md (command 4), from Python."""

import os
from pathlib import Path

import morec

data = Path(os.environ.get("MOREC_DATA", "../shared/data")) / "gestures"
clips = morec.read_folder(data / "clips")
idle = [clip for clip in clips if "_dontcare_" in clip.name]
measured = morec.crossval(clips, data / "clips.tsv", by="person", background=idle, unknown=idle)
figures = measured.evaluation
print(measured)
print("P_C", figures["classification"]["p_c"], "unknown clips with a report", figures["unknown"])
