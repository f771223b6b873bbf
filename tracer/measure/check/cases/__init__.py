"""The cases of `raytree check`, one file per topic. A new case: a function with `@case` in one of them."""
