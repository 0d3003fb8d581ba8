#!/usr/bin/env python3
"""Packs a folder so that the same files give the same bytes: archive.py PARENT NAME ARCHIVE (.tar.gz or .zip)

Entries are in the order of their names, belong to root, and have the time of SOURCE_DATE_EPOCH.
"""

import gzip
import os
import sys
import tarfile
import time
import zipfile
from pathlib import Path


def main() -> None:
    parent, name, archive = Path(sys.argv[1]), sys.argv[2], Path(sys.argv[3])
    epoch = int(os.environ["SOURCE_DATE_EPOCH"])
    files = sorted(path for path in (parent / name).rglob("*") if path.is_file())
    names = [path.relative_to(parent).as_posix() for path in files]
    modes = [0o755 if path.parent.name == name and path.stem in ("morec", "morec-studio") else 0o644 for path in files]
    if archive.suffix == ".zip":
        with zipfile.ZipFile(archive, "w", zipfile.ZIP_DEFLATED) as packed:
            for path, entry in zip(files, names):
                info = zipfile.ZipInfo(entry, time.gmtime(epoch)[:6])
                packed.writestr(info, path.read_bytes(), zipfile.ZIP_DEFLATED, 9)
        return
    with open(archive, "wb") as raw, gzip.GzipFile("", "wb", 9, raw, mtime=0) as zipped:
        with tarfile.open(fileobj=zipped, mode="w", format=tarfile.USTAR_FORMAT) as packed:
            for path, entry, mode in zip(files, names, modes):
                info = packed.gettarinfo(path, entry)
                info.mtime, info.mode = epoch, mode
                info.uid = info.gid = 0
                info.uname = info.gname = "root"
                with open(path, "rb") as file:
                    packed.addfile(info, file)


if __name__ == "__main__":
    main()
