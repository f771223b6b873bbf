"""HTML: the frame of a page (`frame`), a figure in it (`inline_svg`), the numbers of its rays (`numbers`), formulas,
and a page of figures (`figure_page`). `page.css` and `page.js` are part of every page.
"""
