#!/usr/bin/env bash
# Surprise: jax@0.10.2: jax.scipy's Rotation is a tuple (a NamedTuple of one field) whose len() is a TypeError, "Single rotation has
# no len()". Whatever looks for a tuple before it looks further, such as code that shows or stores answers, fails there; unpacking
# it by a star works all the same. SciPy's Rotation has no length either, and is no tuple.
# Guess: no tuple, as in SciPy.
# Seen: isinstance(…, tuple) is True, len() raises TypeError, tuple(…) has one entry.
set -euo pipefail
work=$(mktemp -d); trap 'rm -rf "$work"' EXIT; cd "$work"
python3 -m venv venv
venv/bin/pip install -q --disable-pip-version-check jax==0.10.2 jaxlib==0.10.2 numpy==2.4.6 scipy==1.17.1
venv/bin/python - <<'EOF'
import jax.numpy as jnp
from jax.scipy.spatial.transform import Rotation
from scipy.spatial.transform import Rotation as ScipyRotation

turn = Rotation.from_quat(jnp.array([0.0, 0.0, 0.6, 0.8]))
try:
    length = len(turn)
except TypeError as error:
    length = str(error)
print(isinstance(turn, tuple), "len:", length, "entries:", len(tuple(turn)), "SciPy:", issubclass(ScipyRotation, tuple))
if not (isinstance(turn, tuple) and isinstance(length, str) and len(tuple(turn)) == 1 and not issubclass(ScipyRotation, tuple)):
    raise SystemExit("JAX's Rotation is now another thing.")
EOF
