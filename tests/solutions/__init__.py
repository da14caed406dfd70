"""Solutions as students write them, by people who had not seen the cases; the grader is measured by them."""
