"""The course on a JupyterHub: what `hub` writes, and what `doctor --hub` finds of it."""
