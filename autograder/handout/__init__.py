"""What is given out: the release, zips for an LMS and for Gradescope, the page of all exercises."""
