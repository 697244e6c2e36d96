#!/usr/bin/env bash
# Installs dofkit beside this script: from the wheels that came with it, else from the network.
set -euo pipefail

here="$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)"

fits() {
    "$1" -c 'import sys; sys.exit(sys.version_info < (3, 11))' 2>/dev/null
}

find_python() {
    local version
    if [ -n "${DOFKIT_PYTHON:-}" ]; then
        echo "$DOFKIT_PYTHON"
        return
    fi
    for version in $(cat "$here/pythons") 3 3.14 3.13 3.12 3.11; do
        if fits "python$version"; then
            command -v "python$version"
            return
        fi
    done
    return 1
}

if ! python="$(find_python)"; then
    for version in $(cat "$here/pythons") 3.12 3.11; do
        apt-get install -y "python$version" && break
    done
    python="$(find_python)"
fi
echo "$python" >"$here/python"

pip=("$python" -m pip)
for wheel in "$here"/wheels/pip-*.whl; do
    [ -e "$wheel" ] && pip=("$python" "$wheel/pip")
done

install() {
    "${pip[@]}" install --quiet --disable-pip-version-check --no-warn-script-location --upgrade \
        --target "$here/site" --find-links "$here/wheels" "$@" dofkit
}

mkdir -p "$here/wheels"
install --no-index || install
PYTHONPATH="$here/site" "$python" -P -c 'import dofkit.homework.autograder'
