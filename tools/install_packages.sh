#!/bin/sh
# Installs the packages of tools/packages.txt, or of another list, that this Debian machine lacks. Needs no network when none is missing.
set -eu

list=${1:-$(dirname "$0")/packages.txt}
packages=$(sed -e 's/#.*//' "$list")

if ! command -v dpkg-query >/dev/null 2>&1; then
    echo "This is not a Debian system: install the counterparts of the packages in $list by hand." >&2
    exit 0
fi

missing=
for package in $packages; do
    status=$(dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null || true)
    [ "$status" = installed ] || missing="$missing $package"
done
[ -n "$missing" ] || exit 0

as_root=
if [ "$(id -u)" -ne 0 ]; then
    if ! command -v sudo >/dev/null 2>&1; then
        echo "These packages are missing and sudo is not there to install them:$missing" >&2
        echo "Run as root: apt-get install --no-install-recommends$missing" >&2
        exit 1
    fi
    as_root="sudo"
fi

echo "Installing:$missing"
$as_root apt-get update -q
# shellcheck disable=SC2086
$as_root env DEBIAN_FRONTEND=noninteractive apt-get install -q -y --no-install-recommends $missing </dev/null
