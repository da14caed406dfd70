"""What libraries do with the same numbers: conventions.md says it, and a test holds what it says against this.

measure.py LIBRARY …, run by a Python that has them. Reads {library: [expression]}: code that gives a_T_c, and code that gives the
rotation by roll, pitch and yaw, each in the library's own names. Writes {library: {"version": …, what is asked: what it does,
"expressions": [rows of the rotation matrix that each gives]}}.
"""

import json
import sys
import warnings
from importlib.metadata import version

import numpy as np

warnings.simplefilter("ignore")
np.seterr(all="ignore")

ROLL, PITCH, YAW = 0.1, -0.7, 2.0


def about_z(degrees):
    c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    return np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])


def transform(degrees, p):
    T = np.eye(4)
    T[:3, :3], T[:3, 3] = about_z(degrees), p
    T[:3, :3] = T[:3, :3] @ np.array([[1.0, 0.0, 0.0], [0.0, 0.8, -0.6], [0.0, 0.6, 0.8]])
    return T


A_T_B, B_T_C = transform(90, (1, 2, 3)), transform(200, (-0.4, 0.5, 0.6))


class Library:
    """A library: `quaternion` of a 3x3 matrix and `matrix` of a quaternion, both as it has them; None for what it has not.

    names: what the expressions may use; of: from a 4x4 array to what a_T_b is called in the library, its own object
    """

    def __init__(self, package, quaternion, matrix, names, of=lambda T: T, back=lambda value: value):
        self.version, self.quaternion, self.matrix = package and version(package), quaternion, matrix
        self.names, self.of, self.back = names, of, back

    def expression(self, code):
        """The rotation matrix that code gives."""
        known = {"a_T_b": self.of(A_T_B), "b_T_c": self.of(B_T_C), "roll": ROLL, "pitch": PITCH, "yaw": YAW, "np": np}
        return np.asarray(self.back(eval(code, {**self.names, **known})), dtype=float)[:3, :3].tolist()

    def conventions(self):
        """{what is asked: what it does, in a word or two}."""
        w_first = self.quaternion and abs(self.quaternion(np.eye(3))[0]) > 0.5

        def ordered(x, y, z, w):
            return [w, x, y, z] if w_first else [x, y, z, w]

        found = {
            "four zeros": _matrix(self.matrix, [0, 0, 0, 0]),
            "0, 0, 2, 2": _matrix(self.matrix, ordered(0, 0, 2, 2)),
        }
        if self.quaternion:
            w = self.quaternion(about_z(200))[0 if w_first else 3]
            found["order"] = "w x y z" if w_first else "x y z w"
            found["200° about z"] = "w ≥ 0" if w >= 0 else "w < 0"
            found["a mirror image"] = _quaternion(self.quaternion, np.diag([1.0, 1.0, -1.0]), None)
            found["twice too long"] = _quaternion(
                self.quaternion, 2.0 * about_z(90), ordered(0, 0, np.sqrt(0.5), np.sqrt(0.5))
            )
        return found


def _matrix(of, quaternion):
    try:
        R = np.asarray(of(quaternion), dtype=float)
    except Exception:
        return "error"
    if np.isnan(R).any():
        return "NaN"
    known = {"no turn": np.eye(3), "nine zeros": np.zeros((3, 3)), "normalised": about_z(90)}
    return next((words for words, matrix in known.items() if np.allclose(R, matrix)), "wrong")


def _quaternion(of, matrix, repaired):
    try:
        q = np.asarray(of(matrix), dtype=float)
    except Exception:
        return "error"
    if repaired is None:
        return "taken"
    return "repaired" if np.allclose(np.abs(q @ repaired), 1.0) and np.allclose(q @ q, 1.0) else "wrong"


def homogeneous(R):
    T = np.eye(4)
    T[:3, :3] = R
    return T


def like_ros(package, module):
    return Library(
        package,
        lambda R: module.quaternion_from_matrix(homogeneous(R)),
        lambda q: module.quaternion_matrix(q)[:3, :3],
        vars(module),
    )


def ros():
    from tf import transformations

    return like_ros(None, transformations)


def scipy():
    from scipy.spatial.transform import RigidTransform, Rotation

    return Library(
        "scipy",
        lambda R: Rotation.from_matrix(R).as_quat(),
        lambda q: Rotation.from_quat(q).as_matrix(),
        {"Rotation": Rotation},
        RigidTransform.from_matrix,
        lambda value: value.as_matrix(),
    )


def transformations():
    import transformations as module

    return like_ros("transformations", module)


def trimesh():
    from trimesh import transformations as module

    return like_ros("trimesh", module)


def transforms3d():
    from transforms3d import euler, quaternions

    return Library("transforms3d", quaternions.mat2quat, quaternions.quat2mat, vars(euler))


def pytransform3d():
    from pytransform3d import rotations, transformations

    names = {**vars(rotations), **vars(transformations)}
    return Library("pytransform3d", rotations.quaternion_from_matrix, rotations.matrix_from_quaternion, names)


def pyquaternion():
    from pyquaternion import Quaternion

    return Library(
        "pyquaternion",
        lambda R: Quaternion(matrix=R).elements,
        lambda q: Quaternion(np.array(q, dtype=float)).rotation_matrix,
        {"Quaternion": Quaternion},
        lambda T: Quaternion(matrix=T[:3, :3]),
        lambda value: value.rotation_matrix,
    )


def numpy_quaternion():
    import quaternion

    return Library(
        "numpy-quaternion",
        lambda R: quaternion.as_float_array(quaternion.from_rotation_matrix(R)),
        lambda q: quaternion.as_rotation_matrix(quaternion.quaternion(*q)),
        {"quaternion": quaternion},
        lambda T: quaternion.from_rotation_matrix(T[:3, :3]),
        quaternion.as_rotation_matrix,
    )


def sympy():
    from sympy import Matrix, N, Quaternion, nsimplify

    def quaternion(R):
        return np.array([complex(N(number)).real for number in Quaternion.from_rotation_matrix(Matrix(R)).args[:4]])

    def matrix(q):
        return np.array(Quaternion(*map(nsimplify, q)).to_rotation_matrix().tolist(), dtype=float)

    return Library(
        "sympy",
        quaternion,
        matrix,
        {"Quaternion": Quaternion},
        lambda T: Quaternion.from_rotation_matrix(Matrix(T[:3, :3])),
        lambda value: [[complex(N(number)).real for number in row] for row in value.to_rotation_matrix().tolist()],
    )


def spatialmath():
    from spatialmath import SE3, SO3, base

    return Library(
        "spatialmath-python",
        base.r2q,
        lambda q: base.q2r(np.array(q, dtype=float)),
        {"SO3": SO3},
        SE3,
        lambda value: value.A,
    )


def jaxlie():
    import jax

    jax.config.update("jax_enable_x64", True)
    from jax import numpy as jnp
    from jaxlie import SE3, SO3

    return Library(
        "jaxlie",
        lambda R: np.array(SO3.from_matrix(jnp.array(R)).wxyz),
        lambda q: np.array(SO3(jnp.array(q, dtype=float)).as_matrix()),
        {"SO3": SO3},
        lambda T: SE3.from_matrix(jnp.array(T)),
        lambda value: value.as_matrix(),
    )


def pinocchio():
    import pinocchio as pin

    return Library(
        "pin",
        lambda R: pin.Quaternion(R).coeffs(),
        lambda q: pin.Quaternion(np.array(q, dtype=float)).matrix(),
        {"pin": pin},
        pin.SE3,
    )


def mujoco():
    import mujoco as module

    def quaternion(R):
        q = np.zeros(4)
        module.mju_mat2Quat(q, R.flatten())
        return q

    def matrix(q):
        R = np.zeros(9)
        module.mju_quat2Mat(R, np.array(q, dtype=float))
        return R.reshape(3, 3)

    names = {"mujoco": module, "q": np.zeros(4)}
    return Library("mujoco", quaternion, matrix, names, lambda T: quaternion(T[:3, :3]), lambda _: matrix(names["q"]))


def drake():
    from pydrake.common.eigen_geometry import Quaternion
    from pydrake.math import RigidTransform, RollPitchYaw, RotationMatrix

    return Library(
        "drake",
        lambda R: RotationMatrix(R).ToQuaternion().wxyz(),
        lambda q: RotationMatrix(Quaternion(np.array(q, dtype=float))).matrix(),
        {"RollPitchYaw": RollPitchYaw},
        RigidTransform,
        lambda value: value.GetAsMatrix4() if isinstance(value, RigidTransform) else value.matrix(),
    )


LIBRARIES = {
    "ROS 1": ros, "SciPy": scipy, "transformations": transformations, "trimesh": trimesh, "transforms3d": transforms3d,
    "pytransform3d": pytransform3d, "pyquaternion": pyquaternion, "numpy-quaternion": numpy_quaternion, "SymPy": sympy,
    "spatialmath": spatialmath, "jaxlie": jaxlie, "Pinocchio": pinocchio, "MuJoCo": mujoco, "Drake": drake,
}  # fmt: skip

if __name__ == "__main__":
    asked, found = json.load(sys.stdin), {}
    for name in sys.argv[1:]:
        library = LIBRARIES[name]()
        found[name] = library.conventions()
        found[name]["version"] = library.version
        found[name]["expressions"] = [library.expression(code) for code in asked[name]]
    print(json.dumps(found))
