"""What is handed in: a student's files, made into notebooks of the released shape, and nbgrader's exchange."""
