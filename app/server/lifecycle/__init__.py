"""From the start of the server to its end: checks, logs, warm-up and shutdown."""
