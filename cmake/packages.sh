# For `demo` and `check`: installs what is missing of packages.txt. Expects $root, the folder of the repository.

stop() {
    echo "$(basename "$0"): $*" >&2
    exit 1
}

# The packages of the named sections of packages.txt.
packages_of() {
    local section
    for section in "$@"; do
        sed -n "/^\[$section\]/,/^\[/p" "$root/packages.txt" | sed 's/#.*//; /^\[/d; s/[[:space:]]//g; /^$/d'
    done
}

missing_of() {
    local package
    for package in "$@"; do
        [[ $(dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null) == installed ]] || echo "$package"
    done
}

# install_packages SECTION...
install_packages() {
    local missing as_root=() log
    if ! command -v dpkg-query >/dev/null; then
        stop "this is no Debian system: install what packages.txt lists and run again with --no-packages"
    fi
    mapfile -t missing < <(missing_of $(packages_of "$@"))
    [[ ${#missing[@]} -gt 0 ]] || return 0
    echo "These Debian packages are missing and will be installed: ${missing[*]}"

    command -v apt-get >/dev/null || stop "cannot install packages: there is no apt-get"
    if [[ $(id -u) -ne 0 ]]; then
        command -v sudo >/dev/null || stop "cannot install packages: neither root nor sudo; as root: apt-get install ${missing[*]}"
        as_root=(sudo)
        [[ -t 0 ]] || as_root+=(-n)
        "${as_root[@]}" true 2>/dev/null || stop "cannot install packages: sudo refuses; as root: apt-get install ${missing[*]}"
    fi
    log=$(mktemp)
    # The list of packages is fetched only when what is there does not do.
    if ! apt_get install "${missing[@]}" >"$log" 2>&1; then
        if ! { apt_get update && apt_get install "${missing[@]}"; } >"$log" 2>&1; then
            stop "cannot install packages (no network?): $(grep -m1 '^E:' "$log" || tail -n1 "$log") (all of it: $log)"
        fi
    fi
    rm -f "$log"
    echo "Installed ${#missing[@]} packages."
}

apt_get() {
    "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -y --no-install-recommends -o DPkg::Lock::Timeout=300 "$@"
}
