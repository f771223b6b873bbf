"""The viewer: shows what the tracer computed. Start at `cli` for the commands, at `window.app` for the window."""
