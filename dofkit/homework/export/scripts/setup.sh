#!/usr/bin/env bash
# Installs what dofkit requires beside this script; dofkit itself came with it.
set -euo pipefail

here="$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)"

find_python() {
    local version
    for version in "${DOFKIT_PYTHON:-}" python3 python3.14 python3.13 python3.12 python3.11; do
        if "$version" -c 'import sys, pip; sys.exit(sys.version_info < (3, 11))' 2>/dev/null; then
            command -v "$version"
            return
        fi
    done
    return 1
}

if ! python="$(find_python)"; then
    apt-get update
    apt-get install -y python3.12 python3-pip
    python="$(find_python)"
fi
echo "$python" >"$here/python"

"$python" -m pip install --quiet --disable-pip-version-check --no-warn-script-location --upgrade \
    --target "$here/site" --requirement "$here/requirements.txt"
PYTHONPATH="$here/code:$here/site" "$python" -P -c 'import dofkit.homework.autograder'
