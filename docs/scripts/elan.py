"""ELAN files of a database opened with pympi: elan.py MOREC DATABASE

Exports the labels of every clip as .eaf, opens each file with pympi (pip install pympi-ling), and compares what it finds there
with `morec db samples --json`: class, start and stop of every label to the millisecond, and whose it is.
"""

import collections
import json
import pathlib
import subprocess
import sys
import tempfile

import pympi


def main(morec, database):
    def run(*arguments):
        return subprocess.run([morec, *arguments], check=True, capture_output=True, text=True).stdout

    # The labels of clips are given by their files: `morec:clip` in the header.
    expected = collections.Counter()
    for sample in json.loads(run("db", "samples", database, "--state", "accepted", "--limit", "1000000", "--json")):
        start, stop = (round(1000 * sample[key]) for key in ("start_secs", "stop_secs"))
        expected[sample["clip"], sample["class"], start, max(stop, start + 1)] += 1
    found = collections.Counter()
    files = 0
    with tempfile.TemporaryDirectory() as folder:
        run("db", "export", database, folder, "--form", "eaf")
        for path in sorted(pathlib.Path(folder).rglob("*.eaf")):
            files += 1
            eaf = pympi.Elan.Eaf(str(path))
            clip = dict(eaf.properties)["morec:clip"]
            for tier in eaf.get_tier_names():
                for start, stop, name in eaf.get_annotation_data_for_tier(tier):
                    if tier.split()[0] == "motion":
                        found[clip, name, start, stop] += 1
            # What pympi writes again can be read.
            again = pathlib.Path(folder) / "again" / path.name
            again.parent.mkdir(exist_ok=True)
            eaf.to_file(str(again))
            run("db", "label", database, str(again), "--dry-run")
    print(f"{files} files, {sum(expected.values())} labels, {sum(found.values())} found by pympi {pympi.__version__}")
    for row in (expected - found) + (found - expected):
        print("differs:", row)
    return int(expected != found or not files)


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
