"""Demo page: every shipped scene with its result and figures."""
