"""Why some mutants of a reference or of a notebook's solution are right, too: reasons that several exercises share.

An exercise declares such mutants in its field `equivalent`, as {reason: (what was changed, …)}, with what was changed as
`prove` prints it. Without "notebook: " before it, a declaration holds for the reference and for the notebook's solution.
"""

LISTS = "lists of numbers count as arrays"
NUMPYS_NUMBERS = "the arguments are arrays already, and NumPy's numbers are numbers"
NUMPYS_TRUTH = "NumPy's truth values are truth values"
MINUS_TRUE = "-True is as true as True"
TWO_QUATERNIONS = "q and -q are the same orientation"
SAME_SIZE = "one way or the other, a difference has the same size"
NEAR_TOLERANCE = "the tolerance is about 1e-6 all the same; nobody is asked about what lies so near to it"
WHOLE_STAY_WHOLE = "whole numbers make whole numbers here: they are quarter or half turns"
IN_SINGLE_PRECISION = {"single precision keeps what the tolerance asks for": ("all in single precision",)}
UPPER_LEFT = "only the matrix's upper left is used"

# of helpers in cases.py
READING_A_POSE = {
    LISTS: (
        "position: np.array([pose.position.x, pose.position.y, pose.position.z]) -> "
        "[pose.position.x, pose.position.y, pose.position.z]",
        "orientation: np.array([q.x, q.y, q.z, q.w]) -> [q.x, q.y, q.z, q.w]",
    )
}
MAKING_A_POSE = {
    NUMPYS_NUMBERS: ("pose_of: float(c) -> c", "pose_of: float(c) -> c [2]"),
    TWO_QUATERNIONS: ("pose_of: c -> -c [2]", "pose_of: q -> -q"),
}
