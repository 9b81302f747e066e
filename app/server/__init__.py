"""Parts of a public server: endpoints, admission, logs, security headers, warm-up and shutdown."""
