"""Parts of a public server: routes, endpoints, admission, tokens of sessions, messages and security headers."""
