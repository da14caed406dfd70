#!/usr/bin/env bash
# Gradescope runs this once, as root, when it builds the image that submissions are graded in.
set -euo pipefail
export DEBIAN_FRONTEND=noninteractive
cd /autograder/source

apt-get update
apt-get install -y --no-install-recommends bubblewrap libseccomp2 python3 python3-venv
if ! python3 -c 'import sys; from autograder.environment import OLDEST; sys.exit(sys.version_info < OLDEST)'; then
  echo "This image's Python is too old: choose Ubuntu 24.04 or newer as the base image, and build again." >&2
  exit 1
fi
# Outside /autograder, which run_autograder closes: a notebook's process reads its packages from here.
python3 -m venv /opt/transforms
/opt/transforms/bin/pip install --no-cache-dir --disable-pip-version-check --require-hashes -r environment.lock
