#!/usr/bin/env bash
# Surprise: PyGLM 2.8.3: a matrix reads an array by rows and a list by columns, and writes them so: glm.mat4(a) and
# glm.mat4(a.tolist()) are each other's transposes, and so are numpy.array(m) and numpy.array(m.to_list()). Each way alone comes
# back as it went; who saves the list and reads it as an array has the inverse rotation, and the translation in the last row.
# Guess: one order for both, by columns as OpenGL's, or by rows as NumPy's.
# Seen: rows for the array, columns for the list, both when reading and when writing.
set -euo pipefail
work=$(mktemp -d); trap 'rm -rf "$work"' EXIT; cd "$work"
python3 -m venv venv
venv/bin/pip install -q --disable-pip-version-check PyGLM==2.8.3 numpy==2.4.6
venv/bin/python - <<'EOF'
import glm
import numpy as np

a_T_b = np.array([[0, -1, 0, 1], [1, 0, 0, 2], [0, 0, 1, 3], [0, 0, 0, 1]], dtype=np.float32)
of_array, of_list = glm.mat4(a_T_b), glm.mat4(a_T_b.tolist())
print("of an array, its fourth column:", of_array[3], "of a list:", of_list[3])
print("as an array:", np.array(of_array).tolist(), "as a list:", of_array.to_list())
differ = np.array_equal(np.array(of_array), np.array(of_array.to_list()).T)
if not (differ and of_list == glm.transpose(of_array) and np.array_equal(np.array(of_array), a_T_b)):
    raise SystemExit("PyGLM now reads and writes arrays and lists in another order.")
EOF
