#!/usr/bin/env bash
# Makes a fresh Debian or Ubuntu ready for rtbench: a Rust compiler, a C linker, the Vulkan loader and lavapipe, Mesa's
# Vulkan driver that computes on the CPU. It says what it does and does nothing that is done already.
# Needs root or sudo for packages. Where it may not install a driver it says so and still succeeds: rtbench then runs on
# the CPU twins of its kernels.
#
#   ./setup.sh             set up
#   ./setup.sh --dry-run   only say what would be done
set -euo pipefail
cd "$(dirname "$0")"

say() { printf 'setup: %s\n' "$*"; }

dry_run=
case "${1:-}" in
'') ;;
--dry-run) dry_run=1 ;;
*) say "unknown argument $1 (there is --dry-run)" >&2; exit 2 ;;
esac

# Runs a command, and shows it first.
run() {
    say "\$ $*"
    [ -n "$dry_run" ] || "$@"
}

# --- Who may install packages ----------------------------------------------------------------------------------------

root=()
may_install=1
if ! command -v apt-get >/dev/null; then
    may_install=
    no_packages="this is no Debian or Ubuntu (there is no apt-get)"
elif [ "$(id -u)" != 0 ]; then
    if command -v sudo >/dev/null && { sudo -n true 2>/dev/null || [ -t 0 ]; }; then
        root=(sudo)
    else
        may_install=
        no_packages="packages need root or sudo"
    fi
fi

updated=
install() {
    if [ -z "$updated" ]; then
        run "${root[@]}" apt-get update -q || say "the package lists could not be renewed; trying with the old ones"
        updated=1
    fi
    run "${root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -q --no-install-recommends "$@"
}

# --- Rust, and the linker that it calls ------------------------------------------------------------------------------

wanted=$(sed -n 's/^rust-version = "\(.*\)"/\1/p' Cargo.toml)
[ -d "$HOME/.cargo/bin" ] && PATH="$PATH:$HOME/.cargo/bin"

new_enough() {
    local have
    have=$(cargo --version 2>/dev/null | cut -d' ' -f2) || return 1
    [ -n "$have" ] && [ "$(printf '%s\n%s\n' "$wanted" "$have" | sort -V | head -n 1)" = "$wanted" ]
}

if ! command -v cc >/dev/null; then
    if [ -n "$may_install" ]; then
        say "installing a C compiler, which Rust uses as its linker"
        install gcc libc6-dev
    else
        say "there is no C compiler (cc), which Rust needs as its linker, and $no_packages" >&2
        exit 1
    fi
fi

if new_enough; then
    say "$(cargo --version) is there"
elif command -v rustup >/dev/null; then
    say "bringing Rust to $wanted or newer"
    run rustup toolchain install stable --profile minimal --component rustfmt --component clippy
    run rustup default stable
else
    if ! command -v curl >/dev/null; then
        [ -n "$may_install" ] || { say "there is neither Rust nor curl to get it, and $no_packages" >&2; exit 1; }
        install curl ca-certificates
    fi
    say "installing Rust into ~/.cargo and ~/.rustup with its official installer (https://rustup.rs)"
    if [ -z "$dry_run" ]; then
        curl --proto '=https' --tlsv1.2 -sSf https://sh.rustup.rs |
            sh -s -- -y --no-modify-path --profile minimal --component rustfmt --component clippy
    fi
    # The shell that called this script does not know ~/.cargo/bin yet.
    if [ -n "$may_install" ]; then
        for tool in cargo rustc rustfmt cargo-fmt cargo-clippy clippy-driver rustup; do
            [ -e "/usr/local/bin/$tool" ] || run "${root[@]}" ln -s "$HOME/.cargo/bin/$tool" "/usr/local/bin/$tool"
        done
    else
        say "now run:  . ~/.cargo/env"
    fi
fi

# --- The Vulkan loader and lavapipe ----------------------------------------------------------------------------------

# Version of an installed package, or nothing.
version() { dpkg-query -W -f '${Status} ${Version}' "$1" 2>/dev/null | sed -n 's/^install ok installed //p'; }

# bookworm's own lavapipe (Mesa 22.3) is too old for the kernels; from 24 on it is good.
lavapipe_is_good() {
    [ -n "$(version libvulkan1)" ] && [ -n "$(version mesa-vulkan-drivers)" ] &&
        dpkg --compare-versions "$(version mesa-vulkan-drivers)" ge 24
}

if [ -z "$may_install" ]; then
    say "no Vulkan driver is installed, since $no_packages; without one rtbench runs on the CPU"
elif lavapipe_is_good; then
    say "lavapipe is there (mesa-vulkan-drivers $(version mesa-vulkan-drivers))"
else
    codename=$(. /etc/os-release && printf '%s' "${VERSION_CODENAME:-}")
    from=()
    if [ "$codename" = bookworm ]; then
        from=(-t bookworm-backports)
        if ! grep -rqs 'bookworm-backports' /etc/apt/sources.list /etc/apt/sources.list.d; then
            say "adding bookworm-backports to the package sources: bookworm's own lavapipe is too old"
            if [ -z "$dry_run" ]; then
                printf '%s\n' 'deb http://deb.debian.org/debian bookworm-backports main' |
                    "${root[@]}" tee /etc/apt/sources.list.d/rtbench-backports.list >/dev/null
            fi
        fi
    fi
    say "installing the Vulkan loader and lavapipe"
    install libvulkan1 && install "${from[@]}" mesa-vulkan-drivers ||
        say "that failed; without a Vulkan driver rtbench runs on the CPU"
fi

say "ready: cargo run --release -- sweep"
