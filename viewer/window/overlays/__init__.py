"""Parts that lie over the panels: messages, the help, a dialog, the pointer, the black screen."""
