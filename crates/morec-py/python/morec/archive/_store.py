"""Where an archive lies: a local folder or an S3-compatible store, by the same words."""

from __future__ import annotations

import fnmatch
import os
import random
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any, TypeVar

import pyarrow as pa
import pyarrow.fs as pafs
from daft.io import IOConfig, S3Config

T = TypeVar("T")

#: Bytes that are rather read in vain than asked for by another request.
GAP_BYTES = 256 << 10

#: Attempts at a request, and seconds before the second; they double.
TRIES = 6
FIRST_WAIT_SECS = 0.2


@dataclass(frozen=True)
class Store:
    """A folder that can be read and written.

    Parameters
    ----------
    uri : str
        A local path or ``s3://bucket/prefix``.
    s3 : dict
        ``endpoint_url``, ``key_id``, ``access_key``, ``session_token``, ``region_name``; what is not given comes from the
        environment, as for other programs.
    """

    uri: str
    s3: dict[str, str] = field(default_factory=dict)

    @property
    def is_s3(self) -> bool:
        return self.uri.startswith("s3://")

    @property
    def root(self) -> str:
        return self.uri[len("s3://") :].rstrip("/") if self.is_s3 else os.path.abspath(self.uri)

    def io_config(self) -> IOConfig | None:
        """How Daft reads it."""
        if not self.is_s3:
            return None
        known: dict[str, Any] = {name: value for name, value in self.s3.items() if value is not None}
        endpoint = known.get("endpoint_url", "")
        return IOConfig(s3=S3Config(use_ssl=not endpoint.startswith("http://"), num_tries=10, **known))

    def url(self, name: str) -> str:
        """Address of a file of the store for Daft."""
        return f"s3://{self.root}/{name}" if self.is_s3 else os.path.join(self.root, name)

    def _fs(self) -> pafs.FileSystem:
        if not self.is_s3:
            return pafs.LocalFileSystem()
        options: dict[str, Any] = {"region": self.s3.get("region_name", "us-east-1")}
        for ours, theirs in (("key_id", "access_key"), ("access_key", "secret_key"), ("session_token", "session_token")):
            if self.s3.get(ours):
                options[theirs] = self.s3[ours]
        endpoint = self.s3.get("endpoint_url")
        if endpoint:
            scheme, _, host = endpoint.partition("://")
            options |= {"endpoint_override": host.rstrip("/"), "scheme": scheme}
        return pafs.S3FileSystem(**options)

    def open(self, name: str) -> pa.NativeFile:
        """A file to read some of; FileNotFoundError if there is none. Of a local one nothing is copied."""
        if not self.is_s3:
            return pa.memory_map(self.url(name))
        return patiently(lambda: self._fs().open_input_file(f"{self.root}/{name}"))

    def read(self, name: str) -> bytes:
        """The bytes of a file; FileNotFoundError if there is none."""

        def once() -> bytes:
            with self._fs().open_input_file(f"{self.root}/{name}") as file:
                return bytes(file.read())

        return patiently(once)

    def ranges(self, name: str, places: Sequence[tuple[int, int]]) -> list[bytes]:
        """Stretches of a file, in order of their places, each from a byte on and of a given length; shorter where the file ends."""
        if not self.is_s3:
            with open(self.url(name), "rb", buffering=0) as local:
                return [_from(local, at, size) for at, size in places]

        def once() -> list[bytes]:
            with self._fs().open_input_file(f"{self.root}/{name}") as file:
                return _by_requests(file, places)

        return patiently(once)

    def write(self, name: str, content: bytes) -> None:
        """Writes a file, whole or not at all; what is there under this name goes."""
        if self.is_s3:
            # An object appears when its upload is complete.
            def put() -> None:
                with self._fs().open_output_stream(f"{self.root}/{name}") as file:
                    file.write(content)

            patiently(put)
            return
        path = os.path.join(self.root, name)
        os.makedirs(os.path.dirname(path), exist_ok=True)
        beside = f"{path}.{os.getpid()}.{random.getrandbits(32):08x}.partial"
        try:
            with open(beside, "wb") as out:
                out.write(content)
                out.flush()
                os.fsync(out.fileno())
            os.replace(beside, path)
        finally:
            if os.path.exists(beside):
                os.unlink(beside)

    def delete(self, name: str) -> None:
        patiently(lambda: self._fs().delete_file(f"{self.root}/{name}"))

    def list(self, folder: str = "") -> list[tuple[str, int]]:
        """Names of files below a folder, relative to the store, with their sizes, in order."""

        def once() -> list[tuple[str, int]]:
            base = f"{self.root}/{folder}".rstrip("/")
            selector = pafs.FileSelector(base, recursive=True, allow_not_found=True)
            infos = self._fs().get_file_info(selector)
            files = [info for info in infos if info.type == pafs.FileType.File]
            return sorted((info.path[len(self.root) + 1 :], info.size) for info in files)

        return [(name, size) for name, size in patiently(once) if not name.endswith(".partial")]


def _from(file: Any, at: int, size: int) -> bytes:
    file.seek(at)
    return bytes(file.read(size))


def _by_requests(file: pa.NativeFile, places: Sequence[tuple[int, int]]) -> list[bytes]:
    """Stretches that lie near one another come by one request."""
    found: list[bytes] = []
    while len(found) < len(places):
        first, stop = len(found), 0
        begin = places[first][0]
        for at, size in places[first:]:
            if stop and at > stop + GAP_BYTES:
                break
            stop = max(stop, at + size)
            found.append(b"")
        content = file.read_at(stop - begin, begin)
        found[first:] = [content[at - begin : at - begin + size] for at, size in places[first : len(found)]]
    return found


def patiently(work: Callable[[], T]) -> T:
    """Does what may fail for a moment, again and again; what is not there, or may not be read, fails at once."""
    wait = FIRST_WAIT_SECS
    for attempt in range(TRIES):
        try:
            return work()
        except (FileNotFoundError, PermissionError, IsADirectoryError, NotADirectoryError):
            raise
        except OSError:
            if attempt == TRIES - 1:
                raise
        time.sleep(wait * random.uniform(0.5, 1.5))
        wait *= 2
    raise AssertionError("unreachable")


def split_glob(pattern: str) -> tuple[str, str]:
    """The folder before the first wildcard, and the pattern below it."""
    parts = pattern.split("/")
    for number, part in enumerate(parts):
        if any(sign in part for sign in "*?["):
            return "/".join(parts[:number]) or "/", "/".join(parts[number:])
    return pattern.rstrip("/"), "**/*"


def matches(name: str, pattern: str) -> bool:
    """Whether a name fits a pattern in which ``**`` stands for any folders, none too."""
    return _fits(name.split("/"), pattern.split("/"))


def _fits(names: list[str], patterns: list[str]) -> bool:
    if not patterns:
        return not names
    if patterns[0] == "**":
        return any(_fits(names[skip:], patterns[1:]) for skip in range(len(names) + 1))
    return bool(names) and fnmatch.fnmatchcase(names[0], patterns[0]) and _fits(names[1:], patterns[1:])
