"""The viewer: shows what the tracer computed. Start at `cli` for the commands, at `app` for the window."""
