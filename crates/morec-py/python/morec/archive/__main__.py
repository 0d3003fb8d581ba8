"""``python -m morec.archive create|recognize|discover|search|group|info``."""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Sequence

from .. import MorecError
from . import create, open, use_ray


def parser() -> argparse.ArgumentParser:
    made = argparse.ArgumentParser(prog="python -m morec.archive", description="Archives of motion.")
    made.add_argument("--ray", metavar="ADDRESS", help="run on the Ray cluster at this address; `local` starts one here")
    made.add_argument("--endpoint", metavar="URL", help="of the S3-compatible store, if it is not Amazon's")
    commands = made.add_subparsers(dest="command", required=True)
    one = commands.add_parser("create", help="make an archive, or add what is new")
    one.add_argument("archive")
    one.add_argument("--from-files", metavar="PATTERN", help="clips, as 'raw/**/*.bvh'")
    one.add_argument("--from-database", metavar="DB", help="a database of morec db")
    one.add_argument("--labels", metavar="TSV", help="a table of labels")
    for name in ("subject", "source", "licence"):
        one.add_argument(f"--{name}")
    one = commands.add_parser("recognize", help="what an index recognises in all clips, as tab-separated text")
    one.add_argument("archive")
    one.add_argument("index")
    one.add_argument("-o", "--output", metavar="FOLDER", help="write Parquet there instead")
    one.add_argument("--parts", type=int, default=1, help="divide the index by its classes; no worker holds two parts")
    one = commands.add_parser("discover", help="motions that repeat, without labels, as tab-separated text")
    one.add_argument("archive")
    one.add_argument("-o", "--output", metavar="INDEX", help="write the index that recognises them")
    one.add_argument("--minutes", type=float, default=60.0, help="of clips that are compared in a round")
    one.add_argument("--rounds", type=int, default=2)
    one.add_argument("--seed", type=int, default=1, help="chooses the clips of the first round")
    one = commands.add_parser("search", help="stretches that are like an example")
    one.add_argument("archive")
    one.add_argument("example", help="a file, or a clip of the archive")
    one.add_argument("--start", type=float, default=0.0)
    one.add_argument("--stop", type=float)
    one.add_argument("--limit", type=int, default=20)
    one.add_argument("--mirror", action="store_true")
    one.add_argument("--one-a-clip", action="store_true")
    one.add_argument("--likeliest", action="store_true", help="end after the likeliest clips, sooner: some hits may be missed")
    one = commands.add_parser("group", help="labelled samples in groups of like ones")
    one.add_argument("archive")
    one.add_argument("--classes", default="", help="only these, separated by commas")
    one.add_argument("--groups", type=int, default=8)
    one = commands.add_parser("info", help="how much is in it, as JSON")
    one.add_argument("archive")
    return made


def main(arguments: Sequence[str] | None = None) -> int:
    args = parser().parse_args(arguments)
    if args.ray:
        use_ray(None if args.ray == "local" else args.ray)
    s3 = {"endpoint_url": args.endpoint} if args.endpoint else None
    try:
        return run(args, s3)
    except (MorecError, ValueError, KeyError, OSError) as error:
        text = error.args[0] if isinstance(error, KeyError) else error
        print(f"morec.archive: {text}", file=sys.stderr)
        return 1


def run(args: argparse.Namespace, s3: dict[str, str] | None) -> int:
    if args.command == "create":
        made = create(
            args.archive,
            from_files=args.from_files,
            from_database=args.from_database,
            subject=args.subject,
            source=args.source,
            licence=args.licence,
            s3=s3,
        )
        if args.labels:
            made.add_labels(args.labels)
        print(json.dumps(made.info(), indent=1))
        for row in made.errors().to_pylist():
            print(f"morec.archive: left out: {row['file_path']}: {row['error']}", file=sys.stderr)
        return 0
    archive = open(args.archive, s3=s3)
    if args.command == "info":
        print(json.dumps(archive.info(), indent=1))
    elif args.command == "recognize":
        events = archive.recognize(args.index, parts=args.parts)
        if args.output:
            events.write_parquet(args.output)
        else:
            table(events.column_names, events.to_pylist())
    elif args.command == "discover":
        sets = archive.discover(minutes=args.minutes, rounds=args.rounds, seed=args.seed)
        if args.output:
            sets.index.save(args.output)
        table(sets.events.column_names, sets.events.to_pylist())
    elif args.command == "search":
        hits = archive.search(
            args.example,
            args.start,
            args.stop,
            limit=args.limit,
            mirror=args.mirror,
            one_a_clip=args.one_a_clip,
            exact=not args.likeliest,
        )
        table(hits.columns, hits)
    else:
        classes = [name for name in args.classes.split(",") if name]
        found = archive.group(classes, groups=args.groups)
        table(found.columns, found)
    return 0


def table(columns: Sequence[str], rows: Sequence[dict[str, object]]) -> None:
    """Rows as tab-separated text."""
    print("\t".join(columns))
    for row in rows:
        print("\t".join(f"{row[name]:.4f}" if isinstance(row[name], float) else f"{row[name]}" for name in columns))


if __name__ == "__main__":
    sys.exit(main())
