# For scripts that compile for another platform than this one: `rust_for TARGET` sets `cargo` and `std` so that
# `"${cargo[@]}" build "${std[@]}" --target TARGET` does. Without such a Rust it ends the script with 77.

# Installs Debian's packages, if it is Debian and may.
have_packages() {
    dpkg -s "$@" >/dev/null 2>&1 && return
    [ "$(id -u)" = 0 ] && apt-get update -q && apt-get install -q -y --no-install-recommends "$@"
}

skip() {
    echo "skipped: $*"
    exit 77
}

rust_for() {
    local debian=(rustc-web cargo-web rust-web-src) linker
    cargo=(cargo) std=()
    # Not a pipe: `grep -q` closes it at the first hit, and rustup fails of that now and then.
    if command -v rustup >/dev/null && grep -qx "$1" <<<"$(rustup target list --installed 2>/dev/null)"; then
        return
    fi
    have_packages "${debian[@]}" || skip "there is no Rust for $1 here (rustup target add $1, or Debian's ${debian[*]})"
    # The linker for WebAssembly is `rust-lld`: Debian's compiler has a link to the `lld` of its own version, a package of that name, or
    # none; the toolchain at hand has one as well.
    if [ -L /usr/bin/rust-lld ] && [ ! -e /usr/bin/rust-lld ]; then
        have_packages "$(readlink /usr/bin/rust-lld)"
    fi
    linker=$(find "$(rustc --print sysroot)/lib/rustlib" -name rust-lld -print -quit)
    [ -z "$linker" ] || PATH=$PATH:$(dirname "$linker")
    # Its targets have sources only, and compiling them is behind a flag that a released compiler hides.
    cargo=(env RUSTC=/usr/bin/rustc RUSTC_BOOTSTRAP=1 /usr/bin/cargo)
    std=(-Z "build-std=std,panic_abort")
}
