"""Writes the small indexes from which fuzzing of `read_index` starts (needs the Python package).

    python fuzz/seeds.py

A fuzzer tries thousands of changes a second in an index of a few kilobytes, and four in one of a person's size. So: two
people, two classes, for the templates two bones and samples of a third of a second.
"""

from pathlib import Path

import morec
from morec import synth

FOLDER = Path(__file__).parent / "seeds" / "read_index"
SECS = 0.34


def main():
    FOLDER.mkdir(parents=True, exist_ok=True)
    clips, labels = synth.database(71, people=2, repetitions=1, classes=["push", "bow"], rate_hz=30.0, unknown_share=0.5)
    # The beginning of each sample is a sample of its own: templates are as long as samples.
    spans = []
    for row in labels:
        start = row["start_secs"] if "start_secs" in row else row["start"] / 30.0
        spans += [(row["clip"], name, start + at, start + at + SECS) for name, at in [("push", 0.3), ("pull", 0.8)]]
    indexes = {
        "templates": morec.train(
            clips, spans, everyday="never", mirror="no", bones=["left_forearm", "right_forearm"], params={"max_negatives": 1}
        ),
        "svrdm": morec.train(clips, labels, method="svrdm"),
    }
    for name, index in indexes.items():
        index.save(FOLDER / name)
        print(name, (FOLDER / name).stat().st_size, "bytes")


if __name__ == "__main__":
    main()
