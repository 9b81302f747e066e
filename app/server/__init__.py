"""The page as a small public server: probes, figures, logs, headers, and a stop that loses nothing."""
