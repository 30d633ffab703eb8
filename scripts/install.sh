# Sourced by the scripts beside it: installs programs that are missing, on Debian and Ubuntu.

# The Debian package of a program.
package_of() {
    case $1 in
        vvp) echo iverilog ;;
        *) echo "$1" ;;
    esac
}

# install_missing PROGRAM…: does nothing, and needs no network, when all are there.
install_missing() {
    local program package packages=() as_root=()
    for program in "$@"; do
        command -v "$program" >/dev/null && continue
        package=$(package_of "$program")
        [[ " ${packages[*]-} " == *" $package "* ]] || packages+=("$package")
    done
    if ((${#packages[@]} == 0)); then
        return 0
    fi
    printf 'missing: %s\n' "${packages[*]}"
    if ! command -v apt-get >/dev/null; then
        printf 'There is no apt-get here. Install these yourself, then run this again.\n' >&2
        return 1
    fi
    if ((EUID != 0)); then
        if ! command -v sudo >/dev/null; then
            printf 'Run this as root: apt-get install %s\n' "${packages[*]}" >&2
            return 1
        fi
        as_root=(sudo)
    fi
    "${as_root[@]}" apt-get update -q
    "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
        apt-get install -q -y --no-install-recommends "${packages[@]}"
}

# install_rust_component SUBCOMMAND COMPONENT: for toolchains that came without it.
install_rust_component() {
    cargo "$1" --version >/dev/null 2>&1 && return 0
    if ! command -v rustup >/dev/null; then
        printf '`cargo %s` is missing. Install the Rust component %s.\n' "$1" "$2" >&2
        return 1
    fi
    rustup component add "$2"
}

# install_from_pypi PROGRAM…: into out/python where they are missing; what Debian does not have.
install_from_pypi() {
    local program
    PATH=$PWD/out/python/bin:$PATH
    for program in "$@"; do
        command -v "$program" >/dev/null && continue
        printf 'missing: %s\n' "$program"
        install_missing python3
        python3 -m venv out/python
        out/python/bin/pip install --quiet "$program"
    done
}
