#!/usr/bin/env python3
"""Writes which crates a program is made of: third_party.py FOLDER PACKAGE [CARGO OPTIONS …]

FOLDER/THIRD-PARTY-PACKAGE.txt has the texts of their licences as their packages have them, FOLDER/PACKAGE.cdx.json is the bill of
materials (CycloneDX 1.5). A crate whose package has no text is listed with its licence's name, and the text of that name from another
crate. Nothing is fetched; the same lock file gives the same bytes.
"""

import hashlib
import json
import re
import subprocess
import sys
from pathlib import Path

TEXTS = re.compile(r"(licen[cs]e|copying|notice|unlicense|ofl|ufl)", re.IGNORECASE)


def crates(package: str, options: list[str]) -> list[dict]:
    """What is linked into a package, by name: without what is only built or tested with."""
    tree = subprocess.run(
        ["cargo", "tree", "--locked", "-p", package, "--edges", "normal", "--prefix", "none", "--format", "{p}", *options],
        check=True, capture_output=True, text=True,
    ).stdout
    linked = {tuple(line.split()[:2]) for line in tree.splitlines() if line}
    metadata = subprocess.run(
        ["cargo", "metadata", "--locked", "--all-features", "--format-version", "1"], check=True, capture_output=True, text=True
    ).stdout
    packages = json.loads(metadata)["packages"]
    found = [crate for crate in packages if (crate["name"], "v" + crate["version"]) in linked]
    missing = linked - {(crate["name"], "v" + crate["version"]) for crate in found}
    if missing:
        sys.exit(f"not in the metadata: {sorted(missing)}")
    return sorted(found, key=lambda crate: (crate["name"], crate["version"]))


def texts(crate: dict) -> list[str]:
    """The texts of a crate's licences, and of what it has taken in: SQLite's, fonts'."""
    folder = Path(crate["manifest_path"]).parent
    files = sorted(path for path in folder.rglob("*") if path.is_file() and TEXTS.match(path.name))
    plain = [path for path in files if path.suffix.lower() not in (".rs", ".py", ".toml", ".json", ".html", ".c", ".h")]
    return [path.read_text(encoding="utf-8", errors="replace").strip() for path in plain]


def notices(program: str, linked: list[dict]) -> str:
    """All texts, each once, with the crates that it belongs to."""
    of_text: dict[str, list[str]] = {}
    without = []
    for crate in linked:
        found = texts(crate)
        title = f"{crate['name']} {crate['version']} ({crate['license']})"
        for text in found:
            of_text.setdefault(text, []).append(title)
        if not found:
            by = ", ".join(crate["authors"]) or "its authors"
            without.append(f"    {title} by {by}, {crate['repository'] or ''}")
    parts = [f"Third-party software in {program}, and the texts of its licences."]
    if without:
        parts.append("\n".join(["Packages without a text, under a licence whose text is below:", *without]))
    for text, titles in sorted(of_text.items(), key=lambda item: item[1]):
        parts.append("\n".join(["-" * 100, *dict.fromkeys(titles), "", text]))
    return "\n\n".join(parts) + "\n"


def bill(program: dict, linked: list[dict]) -> dict:
    """The bill of materials."""

    def component(crate: dict, kind: str) -> dict:
        purl = f"pkg:cargo/{crate['name']}@{crate['version']}"
        part = {"type": kind, "bom-ref": purl, "name": crate["name"], "version": crate["version"], "purl": purl}
        # Some packages write `/` for `OR`, as cargo once did.
        part["licenses"] = [{"expression": crate["license"].replace("/", " OR ")}]
        return part

    parts = [component(crate, "library") for crate in linked]
    digest = hashlib.sha256(json.dumps(parts).encode()).hexdigest()
    serial = f"{digest[:8]}-{digest[8:12]}-5{digest[13:16]}-8{digest[17:20]}-{digest[20:32]}"
    metadata = {"component": component(program, "application")}
    return {
        "bomFormat": "CycloneDX", "specVersion": "1.5", "serialNumber": f"urn:uuid:{serial}", "version": 1,
        "metadata": metadata, "components": parts,
    }


def main() -> None:
    folder, package, *options = sys.argv[1:]
    everything = crates(package, options)
    program = next(crate for crate in everything if crate["name"] == package)
    ours = {crate["name"] for crate in everything if crate["source"] is None}
    linked = [crate for crate in everything if crate["name"] not in ours]
    Path(folder, f"THIRD-PARTY-{package}.txt").write_text(notices(package, linked), encoding="utf-8")
    others = [crate for crate in everything if crate is not program]
    text = json.dumps(bill(program, others), indent=1) + "\n"
    Path(folder, f"{package}.cdx.json").write_text(text, encoding="utf-8")
    print(f"{package}: {len(linked)} crates of others")


if __name__ == "__main__":
    main()
