"""Checks at the start of the server, its logs, warm-up and shutdown."""
