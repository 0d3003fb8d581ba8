# What the scripts of a release share. They run from the root of the repository; everything they make is in target/release-files.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

# The field of the workspace's packages: `workspace version`.
workspace() {
    sed -n "s/^$1 = \"\(.*\)\"$/\1/p" Cargo.toml | head -1
}

version=$(workspace version)
out=${MOREC_RELEASE_FILES:-$PWD/target/release-files}
mkdir -p "$out"

run() {
    printf '$ %s\n' "$*"
    "$@"
}

# A folder that is gone when the script ends.
temporary() {
    work=$(mktemp -d)
    trap 'rm -rf "$work"' EXIT
}

# Files get the date of the commit, so that the same sources give the same bytes.
SOURCE_DATE_EPOCH=${SOURCE_DATE_EPOCH:-$(git log -1 --format=%ct)}
export SOURCE_DATE_EPOCH
