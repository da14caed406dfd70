#!/usr/bin/env bash
# Surprise: sympy==1.14.0: Quaternion.from_rotation_matrix of an exact half turn, the case where exact arithmetic should
# shine, is the quaternion 0 + 0i + 0j + 0k: no rotation at all. It multiplies by the sign of a difference that is zero.
# Guess: a half turn about x is i; exact numbers give an exact answer.
# Seen: four zeros for the half turns about x, about (0, 1, -1) and about (1, -2, 3).
set -euo pipefail
work=$(mktemp -d); trap 'rm -rf "$work"' EXIT; cd "$work"
python3 -m venv venv
venv/bin/pip install -q --disable-pip-version-check --no-deps sympy==1.14.0 mpmath==1.3.0
venv/bin/python - <<'EOF'
from sympy import Matrix, Quaternion, eye

answers = []
for axis in ([1, 0, 0], [0, 1, -1], [1, -2, 3]):
    n = Matrix(axis)
    half_turn = 2 * n * n.T / n.dot(n) - eye(3)
    assert half_turn.det() == 1 and half_turn * half_turn == eye(3)
    answers.append(Quaternion.from_rotation_matrix(half_turn))
    print(axis, "->", answers[-1])
if answers != [Quaternion(0, 0, 0, 0)] * 3:
    raise SystemExit("sympy now finds another quaternion for a half turn.")
EOF
