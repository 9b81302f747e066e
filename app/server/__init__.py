"""Parts of a public server: routes, endpoints, admission, tokens of sessions, logs, security headers, warm-up and shutdown."""
