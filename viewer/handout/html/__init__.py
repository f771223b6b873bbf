"""A lesson as one page for a browser. `handout.css` and `handout.js` are part of it."""
