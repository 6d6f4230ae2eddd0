#!/usr/bin/env bash
# Gradescope runs this once, as root, when the image of an assignment is built: it installs the grader.
#
# AUTOGRADER is the folder that Gradescope calls /autograder; another one is for trying it elsewhere, and then PYTHON names
# a Python 3.11 or newer, and nothing of the system is installed.
set -euo pipefail

base=${AUTOGRADER:-/autograder}
source=$base/source
python=${PYTHON:-}

if [ -z "$python" ]; then
    export DEBIAN_FRONTEND=noninteractive
    apt-get update
    # the jail, and fonts for the figures of submissions
    apt-get install --yes --no-install-recommends bubblewrap fonts-dejavu-core libseccomp2 python3 python3-venv
    python=python3
    if ! "$python" -c 'import sys; sys.exit(sys.version_info < (3, 11))'; then
        python=python3.11
        apt-get install --yes --no-install-recommends python3.11 python3.11-venv
    fi
fi
if ! "$python" -c 'import sys; sys.exit(sys.version_info < (3, 11))'; then
    echo "$python is older than Python 3.11: choose a newer base image" >&2
    exit 1
fi

"$python" -m venv --clear "$base/venv"
packages=$(mktemp)
trap 'rm -f "$packages"' EXIT
grep --invert-match --extended-regexp '^(-e|\.)' "$source/loopbook/environment.txt" > "$packages"
"$base/venv/bin/python" -m pip install --quiet --disable-pip-version-check --requirement "$packages"
"$base/venv/bin/python" -m pip install --quiet --disable-pip-version-check --no-deps "$source/loopbook"

# Whoever runs submissions is not root, and finds no key: neither where it was unpacked nor elsewhere.
chmod -R go= "$source"
