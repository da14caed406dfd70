"""What people read of a graded class: feedback for students, the class report, and points as an LMS imports them."""
