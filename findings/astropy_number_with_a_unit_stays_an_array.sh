#!/usr/bin/env bash
# Surprise: astropy 8.0.2: one number with a unit, such as 1.5 * u.m, is a NumPy array of no dimensions whose .item() is such an
# array again. Of a plain array of one number item() is Python's number; code that calls it to be done with arrays (to store a
# value, to compare it) has an array still, and one that asks "is it an array?" before it goes on never comes to an end.
# Guess: item() is the float, or an error because of the unit.
# Seen: item() is a Quantity and a numpy.ndarray; numpy.asarray(…).item() is the float.
set -euo pipefail
work=$(mktemp -d); trap 'rm -rf "$work"' EXIT; cd "$work"
python3 -m venv venv
venv/bin/pip install -q --disable-pip-version-check astropy==8.0.2 numpy==2.4.6
venv/bin/python - <<'EOF'
import astropy.units as u
import numpy as np

length = 1.5 * u.m
item = length.item()
print(type(item).__name__, "is an array:", isinstance(item, np.ndarray), "asarray:", repr(np.asarray(length).item()))
if not (isinstance(item, np.ndarray) and type(np.asarray(length).item()) is float):
    raise SystemExit("A number with a unit is now another thing.")
EOF
