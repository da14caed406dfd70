"""All that nbgrader is for us: its gradebook, its commands, and our place in its own grading."""
